#include "machine/commission/arm_checks.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "base/child_process.h"
#include "base/codes.h"
#include "base/file.h"
#include "base/formatted.h"
#include "base/locked_folder.h"
#include "base/system.h"
#include "base/tr.h"
#include "device/find_arms.h"
#include "machine/codes.h"
#include "machine/commission/commission.h"
#include "session/arm_trial.h"

namespace trephine {

namespace {

constexpr double kPushes_s = 12.0;  // what looking and pushing take, and some more
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

std::vector<CommissionCheck> judgedArms(const std::vector<ArmReadings>& arms) {
  const std::string hold = tr("Commission again, and hold each arm lightly by its tip meanwhile");
  const std::string stiller =
      tr("Commission again, and hold each arm more lightly and as still as you can");
  // Beyond it the pushes differ too much to say that an arm is well: the hand moved, or is firm.
  constexpr double kTooUnlike = 0.03, kSurely = 3.0;
  std::string scatter, pushed;
  double most_steps = 0.0, least = 1.0;
  const std::string calmer = tr("Close other programs, then commission again");
  bool all_heard = true, all_pushed = true, all_sure = true, any_late = false;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const ArmReadings& arm = arms[i];
    const std::string name = (i == 0 ? "" : "; ") + std::to_string(i + 1) + ", " + arm.model + ": ";
    const bool done = arm.phase == MotorEncoderCheck::Phase::done;
    const std::string why = arm.phase == MotorEncoderCheck::Phase::untouched ? tr("nobody held it")
                            : arm.phase == MotorEncoderCheck::Phase::late
                                ? tr("the workstation's ticks came late too often")
                            : done ? tr("not pushed, as its samples scatter, or it states no mass")
                                   : tr("it was let go of, moved too fast, or went away");
    all_heard = all_heard && done;
    any_late = any_late || arm.phase == MotorEncoderCheck::Phase::late;
    all_pushed = all_pushed && done && arm.pushed;
    scatter += name + (done ? formatted("%.3f mm", 1e3 * arm.noise_m) : why);
    if (done)
      most_steps =
          std::max(most_steps, arm.noise_m / std::max(arm.step_m, MotorEncoderCheck::kLeastStep_m));
    if (!done || !arm.pushed) {
      pushed += name + why;
      continue;
    }
    const MotorEncoderCheck::Response& r = arm.response;
    pushed += name + formatted("%.2f along (%.1f, %.1f, %.1f), the weakest %.2f, each \u00b1%.2f",
                               r.least, r.along.x, r.along.y, r.along.z, r.weakest, r.error);
    const bool against = r.least < -kSurely * r.error;
    // What is hardly above nothing, by pushes that are alike, is an arm that does not answer.
    const bool sure = against || r.error < kTooUnlike || r.least > kSurely * r.error;
    all_sure = all_sure && sure;
    if (sure)
      least = std::min(least, against ? r.least : std::max(0.0, std::min(r.least, r.weakest)));
  }
  std::vector<CommissionCheck> checks{judged("arm_encoders", most_steps, scatter)};
  CommissionCheck forces = judged("arm_forces", least, pushed);
  const auto unknown = [](const char* name, const std::string& what, const std::string& next) {
    return notMeasured(name, Fitness::warn, {code::kNotHeld, what, "", next});
  };
  // One that was not tried says nothing of the others, but is not passed either.
  if (!all_heard && checks[0].verdict == Fitness::pass) {
    checks[0] = unknown("arm_encoders", scatter, any_late ? calmer : hold);
  }
  if (forces.verdict == Fitness::pass && !(all_pushed && all_sure)) {
    forces = unknown("arm_forces", pushed,
                     any_late      ? calmer
                     : !all_heard  ? hold
                     : !all_pushed ? tr("See to its encoders first")
                                   : stiller);
  }
  checks.push_back(forces);
  return checks;
}

CommissionCheck countArms() {
  return realArms().count;
}

std::vector<CommissionCheck> tryArms(double patience_s, const Progress& progress) {
  const RealArms here = realArms();
  std::vector<CommissionCheck> checks{here.count};
  const auto with = [&](std::vector<CommissionCheck> more) {
    checks.insert(checks.end(), more.begin(), more.end());
    return checks;
  };
  if (here.arms.empty())
    return with(both(Fitness::warn,
                     {code::kNoArms, tr("No arm is plugged in"), "", tr("See to the arms first")}));
  if (patience_s <= 0.0) {
    return with(both(Fitness::warn, {code::kNotTried, tr("The arms were not tried"), "",
                                     tr("Commission again, and hold each arm meanwhile")}));
  }
  const std::unique_ptr<ArmTrial> trial = ArmTrial::start(here.arms);
  for (std::size_t i = 0; i < trial->size(); ++i) {
    if (trial->problem(i)) return with(both(Fitness::fail, *trial->problem(i)));
    trial->askForAnswer(i, patience_s);
  }
  const auto begun = std::chrono::steady_clock::now();
  bool over = false;
  for (double now_s = 0.0; !over && now_s < patience_s + kPushes_s && !progress.cancelled();) {
    progress.at(now_s / (patience_s + kPushes_s), tr("Hold each arm and move it a little"));
    std::this_thread::sleep_for(kLookEvery);
    const TriedArms& tried = trial->state();
    over = true;
    for (std::size_t i = 0; i < trial->size(); ++i) {
      const MotorEncoderCheck::Phase phase = tried[i].answer;
      over = over && phase != MotorEncoderCheck::Phase::off && !MotorEncoderCheck::runs(phase);
    }
    now_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  }
  std::vector<ArmReadings> answered;
  const TriedArms& tried = trial->state();
  for (std::size_t i = 0; i < trial->size(); ++i) {
    answered.push_back({here.arms[i].model, trial->capabilities(i).encoder_step_m, tried[i].answer,
                        tried[i].noise_m, tried[i].pushed, tried[i].response});
  }
  return with(judgedArms(answered));
}

std::vector<CommissionCheck> checkArms(double patience_s, const Progress& progress) {
  constexpr double kOpening_s = 20.0;
  const auto failedFor = [](const Error& why) {
    std::vector<CommissionCheck> checks = both(Fitness::fail, why);
    checks.insert(checks.begin(), notMeasured("arms", Fitness::fail, why));
    return checks;
  };
  const auto failed = [&](const std::string& what) {
    return failedFor(
        {code::kNotAnswered, what, "",
         tr("Unplug one device after the other, commission again each time, and have the "
            "driver mended of the one without which it passes")});
  };
  const std::string temporary_next = tr("Let TMPDIR name a folder that you may write to");
  const Result<std::filesystem::path> temporary = temporaryFolder();
  if (!temporary) {
    return failedFor(
        {code::kCannotWrite, tr("There is no folder for temporary files"), "", temporary_next});
  }
  const Result<LockedFolder> folder = LockedFolder::make(*temporary, ".trephine-arms-", *temporary);
  if (!folder) {
    return failedFor({code::kCannotWrite, tr("The folder for temporary files cannot be written to"),
                      "", temporary_next});
  }
  if (const Status fits = tryRoom(folder->path(), 100'000); !fits) {
    return failedFor({code::kCannotWrite, tr("The folder for temporary files has no room"), "",
                      tr("Free some space there. {}", temporary_next)});
  }
  const Result<ChildRun> run =
      runChild({{labProgram().string(), "commission", "--arms", "--json", "--out",
                 folder->path().string(), "--wait", plainNumber(patience_s)},
                folder->path() / "said",
                {},
                patience_s + kPushes_s + kOpening_s,
                tr("Hold each arm and move it a little")},
               progress);
  const Result<Json> json = readJsonFile(folder->path() / kArmsAnswer);
  if (!run) return failedFor(run.error());
  if (run->timed_out) return failed(tr("The driver of a device does not answer"));
  if (run->exit_code > 128)
    return failed(tr("The driver of a device ended the program that asked it"));
  const auto checks =
      json && json->contains("checks") ? checksOf(json->at("checks")) : std::nullopt;
  if (checks) return *checks;
  const auto said = errorSaid(folder->path() / "said");
  return said ? failedFor(*said)
              : failed(tr("The program that tries the arms did not come to its end"));
}

}  // namespace trephine
