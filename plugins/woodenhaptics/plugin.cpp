// WoodenHaptics behind the C ABI: arguments, states, and what is counts there and metres here. The
// board is board.h, the arm kinematics.h.
#include "../common/plugin.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "board.h"
#include "kinematics.h"
#include "trephine_device.h"

using namespace trephine::woodenhaptics;
using namespace trephine::plugin;

namespace {

constexpr std::uint32_t kMostArms = 4;
// USB carries a report a millisecond each way; the rest is two threads that take over.
constexpr double kLatency_s = 0.0022;
// Where a link is by a report older than this, nobody knows: it is not carried.
constexpr std::int64_t kFresh_ns = 15'000'000;

struct Arm {
  explicit Arm(const Silence& silence) : board(silence) {}
  Board board;
  Report last;
  Vector angles{};
};

thread_local std::string open_error;

}  // namespace

struct TrephineDevice : trephine::plugin::Opened {
  std::vector<std::unique_ptr<Arm>> arms;
  bool gravity = false;
  double latency_s = kLatency_s;
};

namespace {

// The arm's x towards the user, y right, z up; the host's x right, y up, z towards the user.
Vector toHost(const Vector& arm) {
  return {arm[1], arm[2], arm[0]};
}
Vector toArm(const double host[3]) {
  return {host[2], host[0], host[1]};
}

uint32_t enumerate(TrephineArmInfo* infos, uint32_t capacity) try {
  open_error.clear();
  const std::vector<Found> boards = findBoards();
  for (std::uint32_t i = 0; infos && i < capacity && i < boards.size(); ++i) {
    TrephineArmInfo* info = element(infos, i);
    if (infos->size < sizeof(TrephineArmInfo)) break;
    std::snprintf(info->bus_path, sizeof(info->bus_path), "usb-%s", boards[i].port.c_str());
    std::snprintf(info->serial, sizeof(info->serial), "%s", boards[i].serial.c_str());
    std::snprintf(info->model, sizeof(info->model), "WoodenHaptics");
  }
  return std::uint32_t(boards.size());
} catch (const std::exception&) {
  return 0;
}

int open(const uint32_t* places, uint32_t n_arms, TrephineDevice** out) try {
  if (!out) return TREPHINE_ERROR_ARGUMENT;
  *out = nullptr;
  if (!places || n_arms == 0 || n_arms > kMostArms) {
    open_error = "WoodenHaptics opens one to " + std::to_string(kMostArms) + " arms.";
    return TREPHINE_ERROR_ARGUMENT;
  }
  const std::vector<Found> boards = findBoards();
  auto device = std::make_unique<TrephineDevice>();
  for (std::uint32_t i = 0; i < n_arms; ++i) {
    if (places[i] >= boards.size()) {
      open_error = "There is no WoodenHaptics arm " + std::to_string(places[i]) + ": " +
                   std::to_string(boards.size()) + " are plugged in.";
      return TREPHINE_ERROR_NO_DEVICE;
    }
    if (std::count(places, places + i, places[i]) > 0) {
      open_error = "WoodenHaptics arm " + std::to_string(places[i]) + " is asked for twice.";
      return TREPHINE_ERROR_ARGUMENT;
    }
    device->arms.push_back(std::make_unique<Arm>(device->silence));
    std::string why = device->arms.back()->board.open(boards[places[i]]);
    if (!why.empty()) {
      open_error = std::move(why);
      return TREPHINE_ERROR_NO_DEVICE;
    }
  }
  *out = device.release();
  return TREPHINE_OK;
} catch (const std::exception& e) {
  open_error = e.what();
  return TREPHINE_ERROR_DEVICE;
}

// {"format": "trephine.device", "version": 1, "model": text, "gravity": true or false, "latency_s":
// number}; the last two may be absent.
std::string parse(const char* text, TrephineDevice& into) {
  const auto root = nlohmann::json::parse(text, nullptr, false);
  if (!root.is_object()) return "The text is no JSON object.";
  for (const auto& [key, value] : root.items()) {
    if (key != "format" && key != "version" && key != "model" && key != "gravity" &&
        key != "latency_s") {
      return "Field '" + key + "': unknown; remove it or correct its name.";
    }
  }
  if (root.value("format", nlohmann::json()) != "trephine.device") {
    return "Field 'format': it must be 'trephine.device'.";
  }
  if (root.value("version", nlohmann::json()) != 1) return "Field 'version': this plugin reads 1.";
  const auto gravity = root.value("gravity", nlohmann::json(false));
  if (!gravity.is_boolean()) return "Field 'gravity': expected true or false.";
  const auto latency = root.value("latency_s", nlohmann::json(kLatency_s));
  if (!latency.is_number() || !(latency >= 0.0 && latency <= 0.1)) {
    return "Field 'latency_s': expected a number of seconds from 0 to 0.1.";
  }
  into.gravity = gravity;
  into.latency_s = latency;
  return {};
}

int configure(TrephineDevice* device, const char* json) try {
  if (!device || !json) return TREPHINE_ERROR_ARGUMENT;
  if (device->running) {
    return fail(device, TREPHINE_ERROR_STATE, "The arms are running: stop them to configure them.");
  }
  std::string wrong = parse(json, *device);
  if (!wrong.empty()) return failWith(device, TREPHINE_ERROR_ARGUMENT, std::move(wrong));
  device->configured = true;
  return TREPHINE_OK;
} catch (const std::exception& e) {
  return failWith(device, TREPHINE_ERROR_ARGUMENT, e.what());
}

int capabilities(TrephineDevice* device, uint32_t arm, TrephineCapabilities* out) {
  if (!device || !out || out->size < sizeof(TrephineCapabilities)) return TREPHINE_ERROR_ARGUMENT;
  if (arm >= device->arms.size()) {
    return fail(device, TREPHINE_ERROR_ARGUMENT, "There is no opened arm of that number.");
  }
  out->input_dof = 3;  // its last joints have no encoders
  // A box within reach of the links, and the mass of the links as its tip feels them: estimates,
  // not measured on an arm (README.md).
  const double box_m[] = {0.20, 0.16, 0.12};
  std::copy_n(box_m, 3, out->workspace_m);
  out->peak_force_N = out->continuous_force_N = kPeak_N;
  out->thermal_s = 0.0;
  out->apparent_mass_kg = 0.15;
  out->encoder_step_m = 6.5e-5;  // the coarsest count within the box
  out->rate_hz = 1000.0;
  out->latency_s = device->latency_s;
  return TREPHINE_OK;
}

// The encoders count from where the board was switched on, which has to be the rest of the arm.
int calibrate(TrephineDevice* device, uint32_t arm) {
  if (!device) return TREPHINE_ERROR_ARGUMENT;
  if (arm < device->arms.size()) return TREPHINE_OK;
  return fail(device, TREPHINE_ERROR_ARGUMENT, "There is no opened arm of that number.");
}

int stop(TrephineDevice* device) {
  if (!device) return TREPHINE_ERROR_ARGUMENT;
  device->running = false;
  for (const auto& arm : device->arms) arm->board.stop();
  return TREPHINE_OK;
}

int start(TrephineDevice* device) try {
  if (!device) return TREPHINE_ERROR_ARGUMENT;
  if (!device->configured || device->running) {
    return fail(
        device, TREPHINE_ERROR_STATE,
        device->running ? "The arms are already running." : "The arms have no configuration yet.");
  }
  device->silence.answer(device->silence.asked());
  for (const auto& arm : device->arms) {
    std::string why = arm->board.start();
    if (why.empty()) continue;
    stop(device);
    return failWith(device, TREPHINE_ERROR_NO_DEVICE, std::move(why));
  }
  for (const auto& arm : device->arms) arm->last = Report{};
  device->running = true;
  return TREPHINE_OK;
} catch (const std::exception& e) {
  stop(device);
  return failWith(device, TREPHINE_ERROR_DEVICE, e.what());
}

void report(Arm& arm, TrephineArmState& state) {
  arm.last = arm.board.latest();
  Vector counts{};
  for (std::size_t i = 0; i < 3; ++i) counts[i] = arm.last.counts[i];
  arm.angles = jointAngles(counts);
  const Vector position = toHost(tip(arm.angles));
  state.sequence = arm.last.number;
  state.time_ns = arm.last.time_ns;
  std::copy(position.begin(), position.end(), state.position_m);
  const double straight[] = {1.0, 0.0, 0.0, 0.0};
  std::copy_n(straight, 4, state.orientation);
  state.buttons = 0;
  state.flags = TREPHINE_ARM_CALIBRATED;
}

int read(TrephineDevice* device, double, TrephineArmState* states) {
  if (const int refused = beginExchange(device, states)) return refused;
  for (std::size_t i = 0; i < device->arms.size(); ++i) {
    Arm& arm = *device->arms[i];
    TrephineArmState& state = *element(states, i);
    report(arm, state);
    if (!arm.board.lost()) continue;
    // The other arm goes on, so it is the arm that is lost and not the reading.
    state.flags |= TREPHINE_ARM_LOST;
    device->error = "A WoodenHaptics arm went away: check its plug and try again.";
  }
  return TREPHINE_OK;
}

int write(TrephineDevice* device, const TrephineArmCommand* commands) {
  const std::uint32_t silences = device ? device->silence.asked() : 0;
  if (const int refused = beginExchange(device, commands)) return refused;
  bool refused = false;
  for (std::size_t i = 0; i < device->arms.size(); ++i) {
    Arm& arm = *device->arms[i];
    const double* force_N = element(commands, i)->force_N;
    const bool usable = finite(force_N, 3);
    refused = refused || !usable;
    std::array<std::int16_t, 3> milliamps{};
    if (usable) {
      Vector torques = jointTorques(arm.angles, toArm(force_N));
      if (device->gravity && now_ns() - arm.last.time_ns < kFresh_ns) {
        const Vector up = gravityTorques(arm.angles);
        for (std::size_t joint = 0; joint < 3; ++joint) torques[joint] += up[joint];
      }
      const Vector amps = currents(torques);
      for (std::size_t joint = 0; joint < 3; ++joint) {
        milliamps[joint] = std::int16_t(std::lround(1000.0 * amps[joint]));
      }
    }
    arm.board.command(milliamps);
  }
  return endWrite(device, silences, commands, device->arms.size(), refused);
}

int wait(TrephineDevice* device, double timeout_s) {
  if (!device || !device->running || !(timeout_s >= 0.0)) return TREPHINE_ERROR_ARGUMENT;
  for (const auto& arm : device->arms) {
    if (arm->board.lost()) continue;
    return arm->board.waitForOther(arm->last.number, std::min(timeout_s, 1.0))
               ? TREPHINE_OK
               : TREPHINE_ERROR_TIMEOUT;
  }
  return TREPHINE_ERROR_TIMEOUT;
}

void safeStop(TrephineDevice* device) {
  if (!device) return;
  device->silence.ask();
  for (const auto& arm : device->arms) arm->board.sendNow();
}

const char* lastError(TrephineDevice* device) {
  return device ? device->error : open_error.c_str();
}

void close(TrephineDevice* device) {
  if (device) stop(device);
  delete device;
}

const TrephineDeviceApi kApi = {sizeof(TrephineDeviceApi),
                                TREPHINE_DEVICE_ABI,
                                "woodenhaptics",
                                enumerate,
                                open,
                                configure,
                                capabilities,
                                calibrate,
                                start,
                                read,
                                write,
                                wait,
                                nullptr,  // no simulated hand
                                stop,
                                safeStop,
                                lastError,
                                close};

}  // namespace

extern "C" __attribute__((visibility("default"))) const TrephineDeviceApi* trephine_device_plugin(
    std::uint32_t host_abi) {
  return host_abi == TREPHINE_DEVICE_ABI ? &kApi : nullptr;
}
