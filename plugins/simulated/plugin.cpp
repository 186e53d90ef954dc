// The simulated arms behind the C ABI: arguments, states and flags; the motion is simulated_arm.h.
#include "../common/plugin.h"

#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#include "arm_config.h"
#include "simulated_arm.h"
#include "trephine_device.h"

using trephine::simulated::ArmConfig;
using trephine::simulated::ArmMotion;
using trephine::simulated::DeviceConfig;
using trephine::simulated::Hand;
using trephine::simulated::Vector;
using namespace trephine::plugin;

namespace {

constexpr const char* kBusPaths[] = {"sim-0", "sim-1", "sim-2", "sim-3"};
constexpr std::uint32_t kArms = 4;
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

thread_local char open_error[160] = "";

}  // namespace

struct TrephineDevice : trephine::plugin::Opened {
  std::vector<Arm> arms;
  bool vanished = false;
  std::uint64_t sequence = 0;
  std::int64_t time_ns = 0;
  trephine::simulated::Troubles troubles;
};

namespace {

void copyText(char* to, std::size_t room, const char* text) {
  std::snprintf(to, room, "%s", text);
}

std::uint32_t enumerate(TrephineArmInfo* infos, std::uint32_t capacity) {
  open_error[0] = '\0';
  for (std::uint32_t i = 0; i < kArms && i < capacity; ++i) {
    TrephineArmInfo* info = element(infos, i);
    if (info->size < sizeof(TrephineArmInfo)) return kArms;
    copyText(info->bus_path, sizeof(info->bus_path), kBusPaths[i]);
    copyText(info->serial, sizeof(info->serial), kBusPaths[i]);
    copyText(info->model, sizeof(info->model), "Simulated arm");
  }
  return kArms;
}

int open(const std::uint32_t* places, std::uint32_t n_arms, TrephineDevice** device) {
  if (!device) return TREPHINE_ERROR_ARGUMENT;
  *device = nullptr;
  open_error[0] = '\0';
  if (!places || n_arms == 0 || n_arms > kArms) {
    copyText(open_error, sizeof(open_error), "The simulated plugin opens one to four arms.");
    return TREPHINE_ERROR_ARGUMENT;
  }
  for (std::uint32_t i = 0; i < n_arms; ++i) {
    if (std::count(places, places + i, places[i]) > 0) {
      std::snprintf(open_error, sizeof(open_error), "Simulated arm %u is asked for twice.",
                    places[i]);
      return TREPHINE_ERROR_ARGUMENT;
    }
    if (places[i] >= kArms) {
      std::snprintf(open_error, sizeof(open_error),
                    "There is no simulated arm %u: the arms are 0 to 3.", places[i]);
      return TREPHINE_ERROR_NO_DEVICE;
    }
  }
  try {
    auto* opened = new TrephineDevice;
    opened->arms.resize(n_arms);
    *device = opened;
    return TREPHINE_OK;
  } catch (const std::bad_alloc&) {
    copyText(open_error, sizeof(open_error), "There is no memory for the simulated arms.");
    return TREPHINE_ERROR_DEVICE;
  }
}

int configure(TrephineDevice* device, const char* json) {
  if (!device || !json) return TREPHINE_ERROR_ARGUMENT;
  if (device->running) {
    return fail(device, TREPHINE_ERROR_STATE, "The arms are running: stop them to configure them.");
  }
  try {
    DeviceConfig config;
    if (!parseConfig(json, device->arms.size(), config, device->said)) {
      return fail(device, TREPHINE_ERROR_ARGUMENT, device->said.c_str());
    }
    for (std::size_t i = 0; i < device->arms.size(); ++i) device->arms[i].config = config.arms[i];
    device->troubles = config.troubles;
    device->configured = true;
    return TREPHINE_OK;
  } catch (const std::bad_alloc&) {
    return fail(device, TREPHINE_ERROR_DEVICE, "There is no memory for the configuration.");
  }
}

int capabilities(TrephineDevice* device, std::uint32_t arm, TrephineCapabilities* out) {
  if (!device || !out || out->size < sizeof(TrephineCapabilities)) return TREPHINE_ERROR_ARGUMENT;
  if (arm >= device->arms.size()) {
    return fail(device, TREPHINE_ERROR_ARGUMENT, "There is no opened arm of that number.");
  }
  if (!device->configured) {
    return fail(device, TREPHINE_ERROR_STATE, "The arms have no configuration yet.");
  }
  const std::uint32_t size = out->size, version = out->version;
  std::memcpy(out, &device->arms[arm].config.capabilities, sizeof(TrephineCapabilities));
  out->size = size;
  out->version = version;
  return TREPHINE_OK;
}

int calibrate(TrephineDevice* device, std::uint32_t arm) {
  if (!device) return TREPHINE_ERROR_ARGUMENT;
  if (arm >= device->arms.size()) {
    return fail(device, TREPHINE_ERROR_ARGUMENT, "There is no opened arm of that number.");
  }
  return TREPHINE_OK;  // a simulated arm always knows where it is
}

int start(TrephineDevice* device) {
  if (!device) return TREPHINE_ERROR_ARGUMENT;
  if (!device->configured || device->running) {
    return fail(
        device, TREPHINE_ERROR_STATE,
        device->running ? "The arms are already running." : "The arms have no configuration yet.");
  }
  if (device->vanished) {
    return fail(device, TREPHINE_ERROR_NO_DEVICE, "The simulated arms went away, as configured.");
  }
  device->silence.answer(device->silence.asked());
  for (Arm& arm : device->arms) arm.force_N = {};
  device->running = true;
  return TREPHINE_OK;
}

void report(const TrephineDevice& device, const Arm& arm, TrephineArmState& state) {
  state.sequence = device.sequence;
  state.time_ns = device.time_ns;
  const Vector position = encoderReading(arm.config.parameters, arm.motion.position_m);
  for (int axis = 0; axis < 3; ++axis) {
    state.position_m[axis] = position[std::size_t(axis)];
  }
  for (int i = 0; i < 4; ++i) state.orientation[i] = arm.orientation[i];
  state.buttons = 0;
  state.flags = TREPHINE_ARM_CALIBRATED;
  if (arm.motion.at_limit) state.flags |= TREPHINE_ARM_AT_LIMIT;
}

int lose(TrephineDevice* device, TrephineArmState* states, int code, const char* sentence) {
  for (std::size_t i = 0; i < device->arms.size(); ++i) {
    element(states, i)->flags |= TREPHINE_ARM_LOST;
  }
  return fail(device, code, sentence);
}

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

int read(TrephineDevice* device, double dt_s, TrephineArmState* states) {
  if (const int refused = beginExchange(device, states)) return refused;
  if (device->vanished) {
    return lose(device, states, TREPHINE_ERROR_NO_DEVICE, "The simulated arms went away.");
  }
  if (!(dt_s > 0.0 && dt_s <= kMaxStep_s)) {
    return lose(device, states, TREPHINE_ERROR_ARGUMENT,
                "The time step must be above 0 and at most 0.1 s.");
  }
  device->time_ns += std::int64_t(dt_s * 1e9 + 0.5);
  const trephine::simulated::Troubles& troubles = device->troubles;
  const auto since = [device](double after_s) {
    return after_s >= 0.0 && double(device->time_ns) > after_s * 1e9;
  };
  if (since(troubles.vanish_after_s)) {
    device->vanished = true;
    return lose(device, states, TREPHINE_ERROR_NO_DEVICE, "The simulated arms went away.");
  }
  if (since(troubles.block_after_s)) {
    device->troubles.block_after_s = -1.0;  // once
    block(troubles.block_for_s);
  }
  if (since(troubles.silent_after_s)) return TREPHINE_OK;  // as it was
  ++device->sequence;
  std::uint32_t said = 0;
  if (since(troubles.error_after_s) && !since(troubles.error_after_s + troubles.error_for_s)) {
    said |= TREPHINE_ARM_ERROR;
  }
  if (since(troubles.warm_after_s)) said |= TREPHINE_ARM_WARM;
  const bool silenced = device->silence.holds();
  for (std::size_t i = 0; i < device->arms.size(); ++i) {
    Arm& arm = device->arms[i];
    arm.motion = advance(arm.config.parameters, arm.hand, arm.motion,
                         silenced ? Vector{} : arm.force_N, dt_s);
    TrephineArmState& state = *element(states, i);
    report(*device, arm, state);
    state.flags |= said;
    if (since(troubles.no_number_after_s)) {
      for (double& along : state.position_m) along = std::nan("");
    }
  }
  return TREPHINE_OK;
}

int write(TrephineDevice* device, const TrephineArmCommand* commands) {
  const std::uint32_t silences = device ? device->silence.asked() : 0;
  if (const int refused = beginExchange(device, commands)) return refused;
  if (device->vanished) {
    return fail(device, TREPHINE_ERROR_NO_DEVICE, "The simulated arms went away.");
  }
  bool refused = false;
  for (std::size_t i = 0; i < device->arms.size(); ++i) {
    const TrephineArmCommand& command = *element(commands, i);
    const bool usable = finite(command.force_N, 3);
    Vector& force_N = device->arms[i].force_N;
    force_N = {};
    if (usable) force_N = {command.force_N[0], command.force_N[1], command.force_N[2]};
    refused = refused || !usable;
  }
  return endWrite(device, silences, commands, device->arms.size(), refused);
}

int setTarget(TrephineDevice* device, std::uint32_t place, const double position_m[3],
              const double orientation[4], double hand_k, double hand_b) {
  if (!device || !position_m || !orientation) return TREPHINE_ERROR_ARGUMENT;
  if (place >= device->arms.size()) {
    return fail(device, TREPHINE_ERROR_ARGUMENT, "There is no opened arm of that number.");
  }
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
    return fail(device, TREPHINE_ERROR_ARGUMENT,
                "The hand's pose, stiffness or damping is not possible: it stays as it was.");
  }
  Arm& arm = device->arms[place];
  arm.hand.rest_m = {position_m[0], position_m[1], position_m[2]};
  arm.hand.stiffness_N_per_m = hand_k;
  arm.hand.damping_Ns_per_m = hand_b;
  for (int i = 0; i < 4; ++i) sum += orientation[i] / largest * (orientation[i] / largest);
  const double length = std::sqrt(sum);
  for (int i = 0; i < 4; ++i) arm.orientation[i] = orientation[i] / largest / length;
  if (!device->running && device->configured) {
    // Nothing resists the hand and nobody counts the time: it has brought the arm there.
    arm.motion = ArmMotion{};
    arm.motion.position_m = insideWorkspace(arm.config.parameters, arm.hand.rest_m);
  }
  return TREPHINE_OK;
}

int stop(TrephineDevice* device) {
  if (!device) return TREPHINE_ERROR_ARGUMENT;
  device->running = false;
  return TREPHINE_OK;
}

void safeStop(TrephineDevice* device) {
  if (device) device->silence.ask();
}

const char* lastError(TrephineDevice* device) {
  return device ? device->error : open_error;
}

void close(TrephineDevice* device) {
  delete device;
}

const TrephineDeviceApi kApi = {
    sizeof(TrephineDeviceApi),
    TREPHINE_DEVICE_ABI,
    "simulated",
    enumerate,
    open,
    configure,
    capabilities,
    calibrate,
    start,
    read,
    write,
    nullptr,  // the host paces them
    setTarget,
    stop,
    safeStop,
    lastError,
    close,
};

}  // namespace

extern "C" __attribute__((visibility("default"))) const TrephineDeviceApi* trephine_device_plugin(
    std::uint32_t host_abi) {
  return host_abi == TREPHINE_DEVICE_ABI ? &kApi : nullptr;
}
