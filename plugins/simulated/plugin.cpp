// The simulated arms behind the C ABI: states and flags; the motion is simulated_arm.h.
#include "../common/plugin.h"

#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <string>
#include <vector>

#include "arm_config.h"
#include "simulated_arm.h"

using namespace trephine::plugin;
using namespace trephine::simulated;

namespace {

constexpr double kMaxStep_s = 0.1;      // longer steps are refused: they would block
constexpr double kMaxReach_m = 1000.0;  // of a hand's rest pose
constexpr double kMaxHandStiffness = 1e9;
constexpr double kMaxHandDamping = 1e9;

struct Arm {
  ArmConfig config;
  Hand hand;
  ArmMotion motion;
  Vector force_N{};  // written last
  double orientation[4] = {1.0, 0.0, 0.0, 0.0};
};

void block(double seconds) {
  timespec until{};
  clock_gettime(CLOCK_MONOTONIC, &until);
  until.tv_sec += time_t(seconds);
  until.tv_nsec += long((seconds - double(time_t(seconds))) * 1e9);
  if (until.tv_nsec >= 1'000'000'000) {
    until.tv_nsec -= 1'000'000'000;
    ++until.tv_sec;
  }
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace

struct TrephineDevice : Opened {
  static constexpr const char *kName = "simulated", *kArm = "simulated arm";
  static constexpr std::uint32_t kMostArms = 4;

  std::vector<Arm> arms;
  bool vanished = false;
  std::uint64_t sequence = 0;
  std::int64_t time_ns = 0;
  Troubles troubles;

  static std::vector<int> find() { return {0, 1, 2, 3}; }
  static void describe(int place, TrephineArmInfo& info) {
    copyText(info.bus_path, "sim-" + std::to_string(place));
    copyText(info.serial, "sim-" + std::to_string(place));
    copyText(info.model, "Simulated arm");
  }
  explicit TrephineDevice(const std::vector<int>& places) : arms(places.size()) {}
  std::size_t size() const { return arms.size(); }

  void configure(const char* json) {
    const DeviceConfig config = trephine::simulated::parseConfig(json, arms.size());
    for (std::size_t i = 0; i < arms.size(); ++i) arms[i].config = config.arms[i];
    troubles = config.troubles;
  }
  void capabilities(std::size_t arm, TrephineCapabilities& out) const {
    out = arms[arm].config.capabilities;
  }
  void calibrate(std::size_t) {}  // a simulated arm always knows where it is
  void start() {
    if (vanished) {
      throw Refused{TREPHINE_ERROR_NO_DEVICE, "The simulated arms went away, as configured."};
    }
    for (Arm& arm : arms) arm.force_N = {};
  }
  void stop() {}

  int read(double dt_s, TrephineArmState* states);
  int command(const Forces& forces_N);
  int setTarget(std::size_t place, const double position_m[3], const double orientation[4],
                double hand_k, double hand_b);

 private:
  void report(const Arm& arm, TrephineArmState& state) const;
  int lose(TrephineArmState* states, int code, const char* sentence);
};

void TrephineDevice::report(const Arm& arm, TrephineArmState& state) const {
  state.sequence = sequence;
  state.time_ns = time_ns;
  const Vector position = encoderReading(arm.config.parameters, arm.motion.position_m);
  for (int axis = 0; axis < 3; ++axis) {
    state.position_m[axis] = position[std::size_t(axis)];
  }
  for (int i = 0; i < 4; ++i) state.orientation[i] = arm.orientation[i];
  state.buttons = 0;
  state.flags = TREPHINE_ARM_CALIBRATED;
  if (arm.motion.at_limit) state.flags |= TREPHINE_ARM_AT_LIMIT;
}

int TrephineDevice::lose(TrephineArmState* states, int code, const char* sentence) {
  for (std::size_t i = 0; i < arms.size(); ++i) element(states, i)->flags |= TREPHINE_ARM_LOST;
  return fail(this, code, sentence);
}

int TrephineDevice::read(double dt_s, TrephineArmState* states) {
  if (vanished) {
    return lose(states, TREPHINE_ERROR_NO_DEVICE, "The simulated arms went away.");
  }
  if (!(dt_s > 0.0 && dt_s <= kMaxStep_s)) {
    return lose(states, TREPHINE_ERROR_ARGUMENT,
                "The time step must be above 0 and at most 0.1 s.");
  }
  time_ns += std::int64_t(dt_s * 1e9 + 0.5);
  const auto since = [this](double after_s) {
    return after_s >= 0.0 && double(time_ns) > after_s * 1e9;
  };
  if (since(troubles.vanish_after_s)) {
    vanished = true;
    return lose(states, TREPHINE_ERROR_NO_DEVICE, "The simulated arms went away.");
  }
  if (since(troubles.block_after_s)) {
    troubles.block_after_s = -1.0;  // once
    block(troubles.block_for_s);
  }
  if (since(troubles.silent_after_s)) return TREPHINE_OK;  // as it was
  ++sequence;
  std::uint32_t flags = 0;
  if (since(troubles.error_after_s) && !since(troubles.error_after_s + troubles.error_for_s)) {
    flags |= TREPHINE_ARM_ERROR;
  }
  if (since(troubles.warm_after_s)) flags |= TREPHINE_ARM_WARM;
  const bool silenced = silence.holds();
  for (std::size_t i = 0; i < arms.size(); ++i) {
    Arm& arm = arms[i];
    arm.motion = advance(arm.config.parameters, arm.hand, arm.motion,
                         silenced ? Vector{} : arm.force_N, dt_s);
    TrephineArmState& state = *element(states, i);
    report(arm, state);
    state.flags |= flags;
    if (since(troubles.no_number_after_s)) {
      for (double& along : state.position_m) along = std::nan("");
    }
  }
  return TREPHINE_OK;
}

int TrephineDevice::command(const Forces& forces_N) {
  if (vanished) return fail(this, TREPHINE_ERROR_NO_DEVICE, "The simulated arms went away.");
  for (std::size_t i = 0; i < arms.size(); ++i) {
    arms[i].force_N = {};
    if (forces_N[i]) std::copy_n(forces_N[i], 3, arms[i].force_N.begin());
  }
  return TREPHINE_OK;
}

int TrephineDevice::setTarget(std::size_t place, const double position_m[3],
                              const double orientation[4], double hand_k, double hand_b) {
  double largest = 0.0, sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    largest = std::max(largest, orientation[i] < 0.0 ? -orientation[i] : orientation[i]);
  }
  bool usable = finite(position_m, 3) && finite(orientation, 4) && largest > 0.0 && hand_k >= 0.0 &&
                hand_k <= kMaxHandStiffness && hand_b >= 0.0 && hand_b <= kMaxHandDamping;
  for (int axis = 0; usable && axis < 3; ++axis) {
    usable = position_m[axis] >= -kMaxReach_m && position_m[axis] <= kMaxReach_m;
  }
  if (!usable) {
    return fail(this, TREPHINE_ERROR_ARGUMENT,
                "The hand's pose, stiffness or damping is not possible: it stays as it was.");
  }
  Arm& arm = arms[place];
  arm.hand.rest_m = {position_m[0], position_m[1], position_m[2]};
  arm.hand.stiffness_N_per_m = hand_k;
  arm.hand.damping_Ns_per_m = hand_b;
  for (int i = 0; i < 4; ++i) sum += orientation[i] / largest * (orientation[i] / largest);
  const double length = std::sqrt(sum);
  for (int i = 0; i < 4; ++i) arm.orientation[i] = orientation[i] / largest / length;
  if (!running && configured) {
    // Nothing resists the hand and nobody counts the time: it has brought the arm there.
    arm.motion = ArmMotion{};
    arm.motion.position_m = insideWorkspace(arm.config.parameters, arm.hand.rest_m);
  }
  return TREPHINE_OK;
}

extern "C" __attribute__((visibility("default"))) const TrephineDeviceApi* trephine_device_plugin(
    std::uint32_t host_abi) {
  return trephine::plugin::Plugin<TrephineDevice>::table(host_abi);
}
