#include "lab/commission/arm_checks.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "base/system.h"
#include "device/find_arms.h"
#include "session/arm_trial.h"

namespace trephine {

namespace {

constexpr double kPushes_s = 4.0;   // what looking and pushing take, and some more
constexpr double kNoStep_m = 1e-5;  // of an arm that states none
constexpr std::chrono::milliseconds kLookEvery(50);

struct RealArms {
  std::vector<FoundArm> arms;  // without the simulated
  CommissionCheck count;
};

RealArms realArms() {
  RealArms here;
  const FoundArms found = findArms(pluginFolder());
  std::string models;
  for (const FoundArm& arm : found.arms) {
    if (arm.plugin == "simulated" || arm.plugin == "pedal") continue;
    here.arms.push_back(arm);
    models += (models.empty() ? "" : ", ") + arm.model;
  }
  here.count = judged("arms", double(here.arms.size()), models);
  return here;
}

std::vector<CommissionCheck> both(Fitness verdict, const Error& why) {
  return {notMeasured("arm_encoders", verdict, why), notMeasured("arm_forces", verdict, why)};
}

}  // namespace

std::vector<CommissionCheck> judgedArms(const std::vector<ArmAnswered>& arms) {
  constexpr const char* kHold = "Commission again, and hold each arm lightly by its tip meanwhile";
  std::string scatter, pushed;
  double most_steps = 0.0, least_share = 1.0;
  bool heard = false, all_pushed = true, all_held = true;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const ArmAnswered& arm = arms[i];
    const std::string name = std::to_string(i + 1) + ", " + arm.model + ": ";
    const bool done = arm.phase == ArmAnswer::Phase::done;
    char words[80];
    if (done) {
      const double steps = arm.noise_m / std::max(arm.step_m, kNoStep_m);
      heard = true;
      most_steps = std::max(most_steps, steps);
      std::snprintf(words, sizeof words, "%.3f mm", 1e3 * arm.noise_m);
    }
    scatter += (scatter.empty() ? "" : "; ") + name + (done ? words : "not looked at");
    all_held = all_held && done;
    all_pushed = all_pushed && done && arm.pushed;
    if (done && arm.pushed) {
      least_share = std::min(least_share, *std::ranges::min_element(arm.shares));
      std::snprintf(words, sizeof words, "x %.2f, y %.2f, z %.2f", arm.shares[0], arm.shares[1],
                    arm.shares[2]);
    }
    const char* why = arm.phase == ArmAnswer::Phase::lost ? "let go of, or it went away"
                      : done                              ? "not pushed, as its samples scatter"
                                                          : "nobody held it";
    pushed += (pushed.empty() ? "" : "; ") + name + (done && arm.pushed ? words : why);
  }
  const Error not_held{"NOT_HELD", scatter, "", kHold};
  std::vector<CommissionCheck> checks;
  checks.push_back(heard ? judged("arm_encoders", most_steps, scatter)
                         : notMeasured("arm_encoders", Fitness::warn, not_held));
  CommissionCheck forces = judged("arm_forces", least_share, pushed);
  // One that was not tried says nothing of the others, but is not passed either.
  if (!all_pushed && forces.verdict != Fitness::fail) {
    forces =
        notMeasured("arm_forces", Fitness::warn,
                    {"NOT_PUSHED", pushed, "", all_held ? "See to its encoders first" : kHold});
  }
  checks.push_back(forces);
  return checks;
}

CommissionCheck countArms() {
  return realArms().count;
}

std::vector<CommissionCheck> checkArms(double patience_s, const Progress& progress) {
  const RealArms here = realArms();
  std::vector<CommissionCheck> checks{here.count};
  const auto with = [&](std::vector<CommissionCheck> more) {
    checks.insert(checks.end(), more.begin(), more.end());
    return checks;
  };
  if (here.arms.empty())
    return with(both(Fitness::warn, {"NO_ARMS", "No arm is plugged in", "",
                                     "Plug them in, and commission again"}));
  if (patience_s <= 0.0) {
    return with(both(Fitness::warn, {"NOT_TRIED", "The arms were not tried", "",
                                     "Commission again, and hold each arm meanwhile"}));
  }
  const std::unique_ptr<ArmTrial> trial = ArmTrial::start(here.arms);
  for (std::size_t i = 0; i < trial->size(); ++i) {
    if (trial->problem(i)) return with(both(Fitness::fail, *trial->problem(i)));
    trial->askForAnswer(i, patience_s);
  }
  const auto begun = std::chrono::steady_clock::now();
  bool over = false;
  for (double now_s = 0.0; !over && now_s < patience_s + kPushes_s && !progress.cancelled();) {
    progress.at(now_s / (patience_s + kPushes_s), "Hold each arm and move it a little");
    std::this_thread::sleep_for(kLookEvery);
    const TriedArms& tried = trial->state();
    over = true;
    for (std::size_t i = 0; i < trial->size(); ++i) {
      const ArmAnswer::Phase phase = tried[i].answer;
      over = over && phase != ArmAnswer::Phase::off && !ArmAnswer::runs(phase);
    }
    now_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  }
  std::vector<ArmAnswered> answered;
  const TriedArms& tried = trial->state();
  for (std::size_t i = 0; i < trial->size(); ++i) {
    answered.push_back({here.arms[i].model, trial->capabilities(i).encoder_step_m, tried[i].answer,
                        tried[i].noise_m, tried[i].pushed, tried[i].shares});
  }
  return with(judgedArms(answered));
}

}  // namespace trephine
