#include "session/arm_trial.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

#include "base/rt/thread.h"
#include "base/tr.h"
#include "haptics/device_calls.h"
#include "haptics/device_rules.h"
#include "haptics/loop_clock.h"
#include "haptics/watchdog.h"
#include "session/arm_devices.h"

namespace trephine {

namespace {

constexpr double kPeriod_s = 1e-3;
constexpr std::int64_t kLate_ns = 3'000'000;
constexpr int kPriority = 80;
constexpr auto kEndPatience = std::chrono::milliseconds(200);
constexpr auto kLetGoPatience = std::chrono::milliseconds(300);  // with all that comes after it
constexpr auto kWatchEvery = std::chrono::milliseconds(4);

}  // namespace

// Owned by the trial and its threads together: a device may keep each of them for ever.
struct ArmTrial::Engine {
  struct Opened {
    std::shared_ptr<Device> device;  // silence() may have it beside; null: closed
    std::vector<std::size_t> arms;   // of the trial
  };
  std::vector<Opened> devices;
  std::vector<TrephineCapabilities> capabilities;
  std::vector<ForceTest> tests;
  std::vector<MotorEncoderCheck> answers;
  std::array<std::uint64_t, kMostTried> sequences{};
  std::int64_t last_ns = 0;  // of the tick before
  std::array<Vec3, kMostTried> first_m{};
  std::array<SilenceRule, kMostTried> silences{};
  TriedArms arms{};
  rt::LatestValue<TriedArms> seen;
  std::atomic<double> asked_N[kMostTried]{};  // for the next test of each; 0: none
  std::atomic<double> patience_s[kMostTried]{};  // for the next answer of each; 0: none
  std::atomic<bool> end_force{false}, stop{false};
  DeviceCalls calls;  // those of the thread
  std::mutex mutex;  // of the devices, which silence() may have beside
  std::atomic<std::uint64_t> ticks{0};
  std::atomic<bool> stands_still{false};

  std::vector<std::optional<Error>> problems;

  Status open(const std::vector<FoundArm>& found, const std::vector<std::size_t>& which);
  void take(std::size_t i, const TrephineArmState& state);
  bool tick(std::int64_t now_ns);
  void run();
  void silence();
  void watch();
  void end(rt::AbandonableThread arms, rt::AbandonableThread watch);
};

// Of those that are not closed, and stay open until it has silenced them.
void ArmTrial::Engine::silence() {
  std::vector<std::shared_ptr<Device>> all;
  {
    std::lock_guard lock(mutex);
    for (const Opened& of : devices) all.push_back(of.device);
  }
  calls.calledLast(all.size(), [&](std::size_t d) {
    if (all[d]) all[d]->safeStop();
    all[d].reset();
  });
}

// Takes the force away where the arms' thread stands still, and at the end.
void ArmTrial::Engine::watch() {
  HostClock clock;
  Standstill still;
  while (!stop) {
    std::this_thread::sleep_for(kWatchEvery);
    const bool begins = still.begins(ticks, true, clock.now_ns());
    stands_still = still.since_ns() != 0;
    if (begins) silence();
  }
  silence();
}

// Waits for both threads, leaves behind the device that keeps one, and closes the others.
void ArmTrial::Engine::end(rt::AbandonableThread arms_thread, rt::AbandonableThread watch_thread) {
  // A thread that is in no call comes to its end, or into one.
  const std::optional<std::size_t> held =
      arms_thread.end(kEndPatience, [this] { return calls.leaveBehind(); });
  if (held) devices[*held].device->leaveBehind();
  watch_thread.end(std::chrono::milliseconds(0), [&] { return held.has_value(); });
  for (std::size_t d = 0; d < devices.size(); ++d) {
    if (d == held) continue;
    std::shared_ptr<Device> closing;  // beyond the lock: it may take its time
    std::lock_guard lock(mutex);
    closing.swap(devices[d].device);
  }
}

void ArmTrial::Engine::take(std::size_t i, const TrephineArmState& state) {
  TriedArm& arm = arms[i];
  const double* p = state.position_m;
  const double* q = state.orientation;
  const Pose pose_m{{p[0], p[1], p[2]}, Quat(q[0], q[1], q[2], q[3])};
  arm.buttons = state.buttons;
  arm.flags = state.flags;
  if (!isFinite(pose_m)) {  // no pose: it is as if the arm were gone
    arm.flags |= TREPHINE_ARM_LOST;
    return;
  }
  arm.pose_m = pose_m;
  if (arm.samples++ == 0) first_m[i] = arm.pose_m.position;
  arm.moved_m = std::max(arm.moved_m, glm::length(arm.pose_m.position - first_m[i]));
}

bool ArmTrial::Engine::tick(std::int64_t now_ns) {
  const bool end = end_force.exchange(false);
  const std::int64_t before_ns = std::exchange(last_ns, now_ns);
  const bool late = before_ns != 0 && now_ns - before_ns > kLate_ns;
  for (std::size_t d = 0; d < devices.size(); ++d) {
    const Opened& of = devices[d];
    std::array<TrephineArmState, kMostTried> states{};
    std::array<TrephineArmCommand, kMostTried> commands{};
    if (!calls.make(d, [&] { of.device->read(kPeriod_s, states.data()); })) return false;
    for (std::size_t n = 0; n < of.arms.size(); ++n) {
      const std::size_t i = of.arms[n];
      take(i, states[n]);
      if (const double most_N = asked_N[i].exchange(0.0); most_N > 0.0) tests[i].ask(most_N);
      if (const double patience = patience_s[i].exchange(0.0); patience > 0.0) {
        const TrephineCapabilities& of_arm = capabilities[i];
        answers[i].ask(of_arm.apparent_mass_kg, of_arm.latency_s,
                       std::min(of_arm.continuous_force_N, of_arm.peak_force_N), patience,
                       of_arm.encoder_step_m);
      }
      if (end) tests[i].end();
      if (end) answers[i] = MotorEncoderCheck();
      TriedArm& arm = arms[i];
      if (silences[i].tick(states[n].sequence, kPeriod_s, now_ns)) arm.flags |= TREPHINE_ARM_LOST;
      const bool away = arm.flags & (TREPHINE_ARM_LOST | TREPHINE_ARM_ERROR);
      const bool no_hand = arm.flags & TREPHINE_ARM_NO_HAND;
      const HandSample sample{arm.pose_m.position, arm.buttons != 0, no_hand, away};
      arm.force_N = tests[i].tick(sample, kPeriod_s);
      arm.test = tests[i].phase();
      const bool fresh = states[n].sequence != std::exchange(sequences[i], states[n].sequence);
      const Vec3 push_N = answers[i].tick(sample, fresh, late, kPeriod_s);
      const bool asked = MotorEncoderCheck::runs(answers[i].phase());
      arm.answer = answers[i].phase();
      arm.noise_m = answers[i].noise_m();
      arm.response = answers[i].response();
      arm.pushed = answers[i].pushed();
      commands[n].size = sizeof(TrephineArmCommand);
      for (int axis = 0; asked && axis < 3; ++axis) commands[n].force_N[axis] = push_N[axis];
      if (!asked) commands[n].force_N[1] = arm.force_N;
    }
    if (!calls.make(d, [&] { of.device->write(commands.data()); })) return false;
  }
  seen.write(arms);
  ++ticks;
  return true;
}

void ArmTrial::Engine::run() {
  rt::nameThread("arm trial");
  rt::sharpenTimers();
  (void)rt::requestRealTime(kPriority);  // else it is late more often
  HostClock clock;
  TickSchedule schedule(std::int64_t(kPeriod_s * 1e9));
  bool here = true;
  while (here && !stop) {
    schedule.waitForTick(clock);
    here = tick(clock.now_ns());
  }
  for (std::size_t d = 0; here && d < devices.size(); ++d) {
    here = calls.make(d, [&] { devices[d].device->stop(); });
  }
}

// These arms of one plugin as one device.
Status ArmTrial::Engine::open(const std::vector<FoundArm>& found,
                              const std::vector<std::size_t>& which) {
  const std::string& name = found[which.front()].plugin;
  std::vector<std::uint32_t> places;
  for (std::size_t i : which) places.push_back(found[i].place);
  Result<std::unique_ptr<Device>> device = openDevice(name, places, deviceFile(name));
  if (!device) return device.error();
  for (std::size_t n = 0; n < which.size(); ++n) {
    capabilities[which[n]] = (*device)->capabilities(n);
  }
  if (Status started = (*device)->start(); !started) return started;
  devices.push_back({*std::move(device), which});
  return {};
}

std::unique_ptr<ArmTrial> ArmTrial::start(const std::vector<FoundArm>& arms) {
  auto engine = std::make_shared<Engine>();
  std::map<std::string, std::vector<std::size_t>> by_plugin;
  const std::size_t count = std::min(arms.size(), kMostTried);
  for (std::size_t i = 0; i < count; ++i) by_plugin[arms[i].plugin].push_back(i);
  engine->capabilities.resize(count);
  engine->tests.resize(count);
  engine->answers.resize(count);
  engine->problems.resize(count);
  for (const auto& [name, of] : by_plugin) {
    if (engine->open(arms, of)) continue;
    // Each alone, for who it is that cannot be had; then those that can together.
    std::vector<std::size_t> good;
    for (std::size_t i : of) {
      if (Status alone = engine->open(arms, {i}); !alone) {
        engine->problems[i] = alone.error();
        continue;
      }
      engine->devices.pop_back();
      good.push_back(i);
    }
    if (good.empty()) continue;
    const Status together = engine->open(arms, good);
    for (std::size_t i : good) {
      if (!together) engine->problems[i] = together.error();
    }
  }
  std::unique_ptr<ArmTrial> trial(new ArmTrial);
  trial->engine_ = engine;
  trial->thread_ = rt::AbandonableThread([engine] { engine->run(); });
  trial->watch_thread_ = rt::AbandonableThread([engine] { engine->watch(); });
  return trial;
}

ArmTrial::~ArmTrial() {
  engine_->stop = true;
  // Whatever a plugin does in these calls, it does not keep this thread.
  rt::AbandonableThread([engine = engine_, arms = std::move(thread_),
                         watch = std::move(watch_thread_)]() mutable {
    engine->end(std::move(arms), std::move(watch));
  }).end(kLetGoPatience, [] { return true; });
}

std::size_t ArmTrial::size() const {
  return engine_->capabilities.size();
}

const std::optional<Error>& ArmTrial::problem(std::size_t arm) const {
  return engine_->problems[arm];
}

const TrephineCapabilities& ArmTrial::capabilities(std::size_t arm) const {
  return engine_->capabilities[arm];
}

const TriedArms& ArmTrial::state() {
  engine_->seen.refresh();
  shown_ = engine_->seen.value();
  if (!engine_->stands_still) return shown_;
  for (TriedArm& arm : shown_) {  // what was sent last is not what is sent now
    arm.flags |= TREPHINE_ARM_LOST;
    arm.force_N = 0.0;
    if (ForceTest::runs(arm.test)) arm.test = ForceTest::Phase::lost;
    if (MotorEncoderCheck::runs(arm.answer)) arm.answer = MotorEncoderCheck::Phase::lost;
  }
  return shown_;
}

void ArmTrial::askForForce(std::size_t arm, double most_N) {
  engine_->asked_N[arm] = std::min({most_N, engine_->capabilities[arm].continuous_force_N,
                                    engine_->capabilities[arm].peak_force_N});
}

void ArmTrial::askForAnswer(std::size_t arm, double patience_s) {
  engine_->patience_s[arm] = patience_s;
}

void ArmTrial::endForce() {
  engine_->end_force = true;
}

}  // namespace trephine
