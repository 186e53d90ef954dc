// Phantom and Touch arms behind the C ABI: arguments, states, configuration. The maker's library is
// hd.h, what goes on in its scheduler arms.h.
#include "../common/plugin.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "arms.h"
#include "trephine_device.h"

using namespace trephine::openhaptics;
using namespace trephine::plugin;

namespace {

struct Config {
  std::vector<std::string> names;
  double rate_hz = 1000.0;
  // As the maker's sheet of the Phantom Omni has them, as remembered; the library does not say.
  double apparent_mass_kg = 0.045, encoder_step_m = 5.5e-5;
  // The answer goes out in the frame of its sample, and the arm's bus takes a millisecond.
  double latency_s = 0.0015;
};

// The maker's scheduler is one a process.
std::atomic<bool> in_use{false};
thread_local std::string open_error;

}  // namespace

struct TrephineDevice : trephine::plugin::Opened {
  explicit TrephineDevice(const Library& hd) : arms(hd, silence) {}
  std::vector<std::uint32_t> places;  // of its arms among the configured names
  Arms arms;
  Config config;
  std::array<std::array<double, 3>, kMostArms> centre_m{};  // of the workspace
  std::uint64_t given = 0;                                  // number of the last sample read
};

namespace {

// The library finds no arms by itself: these are places for the names that a configuration gives.
uint32_t enumerate(TrephineArmInfo* infos, uint32_t capacity) try {
  open_error.clear();
  if (!loadLibrary(open_error)) return 0;
  for (std::uint32_t i = 0; infos && i < std::min<std::uint32_t>(capacity, kMostArms); ++i) {
    TrephineArmInfo* info = element(infos, i);
    if (infos->size < sizeof(TrephineArmInfo)) break;
    std::snprintf(info->bus_path, sizeof(info->bus_path), "openhaptics-%u", i);
    std::snprintf(info->model, sizeof(info->model), "Phantom or Touch");
  }
  return kMostArms;
} catch (const std::exception&) {
  return 0;
}

int open(const uint32_t* places, uint32_t n_arms, TrephineDevice** out) try {
  if (!out) return TREPHINE_ERROR_ARGUMENT;
  *out = nullptr;
  if (!places || n_arms == 0 || n_arms > kMostArms) {
    open_error = "OpenHaptics opens one or two arms.";
    return TREPHINE_ERROR_ARGUMENT;
  }
  for (std::uint32_t i = 0; i < n_arms; ++i) {
    if (places[i] >= kMostArms || std::count(places, places + i, places[i]) > 0) {
      open_error = "OpenHaptics arm " + std::to_string(places[i]) +
                   " is none, or is asked for twice: the arms are 0 and 1.";
      return TREPHINE_ERROR_NO_DEVICE;
    }
  }
  const Library* hd = loadLibrary(open_error);
  if (!hd) return TREPHINE_ERROR_NO_DEVICE;
  if (in_use.exchange(true)) {
    open_error = "The OpenHaptics arms are in use already: stop the exercise that has them.";
    return TREPHINE_ERROR_STATE;
  }
  try {
    auto device = std::make_unique<TrephineDevice>(*hd);
    device->places.assign(places, places + n_arms);
    *out = device.release();
  } catch (...) {
    in_use = false;
    throw;
  }
  return TREPHINE_OK;
} catch (const std::exception& e) {
  open_error = e.what();
  return TREPHINE_ERROR_DEVICE;
}

struct ConfigNumber {
  const char* key;
  double low, high;
  double Config::*member;
};
constexpr ConfigNumber kConfigNumbers[] = {
    {"rate_hz", 500.0, 1600.0, &Config::rate_hz},
    {"apparent_mass_kg", 1e-4, 100.0, &Config::apparent_mass_kg},
    {"encoder_step_m", 0.0, 0.01, &Config::encoder_step_m},
    {"latency_s", 0.0, 0.1, &Config::latency_s},
};

// Empty, or what is wrong: README.md has the fields.
std::string parse(const char* text, const std::vector<std::uint32_t>& places, Config& into) {
  const auto root = nlohmann::json::parse(text, nullptr, false);
  if (!root.is_object()) return "The text is no JSON object.";
  for (const auto& [key, value] : root.items()) {
    const bool number = std::any_of(std::begin(kConfigNumbers), std::end(kConfigNumbers),
                                    [&key = key](const ConfigNumber& n) { return key == n.key; });
    if (!number && key != "format" && key != "version" && key != "model" && key != "names") {
      return "Field '" + key + "': unknown; remove it or correct its name.";
    }
  }
  if (root.value("format", nlohmann::json()) != "trephine.device") {
    return "Field 'format': it must be 'trephine.device'.";
  }
  if (root.value("version", nlohmann::json()) != 1) return "Field 'version': this plugin reads 1.";
  for (const ConfigNumber& number : kConfigNumbers) {
    if (!root.contains(number.key)) continue;
    const auto& value = root[number.key];
    if (!value.is_number() || !(value >= number.low && value <= number.high)) {
      return "Field '" + std::string(number.key) + "': expected a number from " +
             nlohmann::json(number.low).dump() + " to " + nlohmann::json(number.high).dump() + ".";
    }
    into.*number.member = value;
  }
  if (into.rate_hz != 500.0 && into.rate_hz != 1000.0 && into.rate_hz != 1600.0) {
    return "Field 'rate_hz': the maker's scheduler has 500, 1000 or 1600.";
  }
  const auto names = root.value("names", nlohmann::json::array({""}));
  const std::uint32_t most = *std::max_element(places.begin(), places.end());
  bool words = names.is_array();
  for (const auto& each : names) words = words && each.is_string();
  if (!words || names.size() <= most) {
    return "Field 'names': expected the names of " + std::to_string(most + 1) +
           " arms, as the maker's set-up has them.";
  }
  for (std::uint32_t place : places) into.names.push_back(names[place]);
  return {};
}

int configure(TrephineDevice* device, const char* json) try {
  if (!device || !json) return TREPHINE_ERROR_ARGUMENT;
  if (device->running) {
    return fail(device, TREPHINE_ERROR_STATE, "The arms are running: stop them to configure them.");
  }
  Config config;
  std::string wrong = parse(json, device->places, config);
  if (!wrong.empty()) return failWith(device, TREPHINE_ERROR_ARGUMENT, std::move(wrong));
  device->configured = false;
  wrong = device->arms.open(config.names);
  if (!wrong.empty()) return failWith(device, TREPHINE_ERROR_NO_DEVICE, std::move(wrong));
  for (std::size_t arm = 0; arm < device->places.size(); ++arm) {
    const std::array<double, 6> box_mm = device->arms.workspace_mm(arm);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      device->centre_m[arm][axis] = 0.5e-3 * (box_mm[axis + 3] + box_mm[axis]);
    }
  }
  device->config = std::move(config);
  device->configured = true;
  return TREPHINE_OK;
} catch (const std::exception& e) {
  return failWith(device, TREPHINE_ERROR_ARGUMENT, e.what());
}

int capabilities(TrephineDevice* device, uint32_t arm, TrephineCapabilities* out) {
  if (!device || !out || out->size < sizeof(TrephineCapabilities)) return TREPHINE_ERROR_ARGUMENT;
  if (arm >= device->places.size()) {
    return fail(device, TREPHINE_ERROR_ARGUMENT, "There is no opened arm of that number.");
  }
  if (!device->configured) {
    return fail(device, TREPHINE_ERROR_STATE, "The arms have no configuration yet.");
  }
  Arms& arms = device->arms;
  out->input_dof = arms.integer(arm, kInputDof) >= 6 ? 6 : 3;
  const std::array<double, 6> box_mm = arms.workspace_mm(arm);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out->workspace_m[axis] = 1e-3 * (box_mm[axis + 3] - box_mm[axis]);
  }
  out->peak_force_N = arms.number(arm, kNominalMaxForce);
  out->continuous_force_N =
      std::min(out->peak_force_N, arms.number(arm, kNominalMaxContinuousForce));
  out->thermal_s = 0.0;  // its driver watches its motors and says so
  out->apparent_mass_kg = device->config.apparent_mass_kg;
  out->encoder_step_m = device->config.encoder_step_m;
  out->rate_hz = device->config.rate_hz;
  out->latency_s = device->config.latency_s;
  return TREPHINE_OK;
}

int calibrate(TrephineDevice* device, uint32_t arm) try {
  if (!device) return TREPHINE_ERROR_ARGUMENT;
  if (arm >= device->places.size()) {
    return fail(device, TREPHINE_ERROR_ARGUMENT, "There is no opened arm of that number.");
  }
  if (!device->configured) {
    return fail(device, TREPHINE_ERROR_STATE, "The arms have no configuration yet.");
  }
  std::string why = device->arms.calibrate(arm);
  return why.empty() ? TREPHINE_OK : failWith(device, TREPHINE_ERROR_DEVICE, std::move(why));
} catch (const std::exception&) {
  return fail(device, TREPHINE_ERROR_DEVICE, "There is no memory for the arms.");
}

int start(TrephineDevice* device) try {
  if (!device) return TREPHINE_ERROR_ARGUMENT;
  if (!device->configured || device->running) {
    return fail(
        device, TREPHINE_ERROR_STATE,
        device->running ? "The arms are already running." : "The arms have no configuration yet.");
  }
  device->silence.answer(device->silence.asked());
  device->given = 0;
  std::string why = device->arms.start(device->config.rate_hz);
  if (!why.empty()) return failWith(device, TREPHINE_ERROR_DEVICE, std::move(why));
  device->running = true;
  return TREPHINE_OK;
} catch (const std::exception&) {
  return fail(device, TREPHINE_ERROR_DEVICE, "There is no memory for the arms.");
}

// A rotation as a unit quaternion: the largest part first, so that nothing is divided by almost
// zero.
void turnOf(const double* m, double out[4]) {
  const double r[3][3] = {{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}};
  const double squares[4] = {1.0 + r[0][0] + r[1][1] + r[2][2], 1.0 + r[0][0] - r[1][1] - r[2][2],
                             1.0 - r[0][0] + r[1][1] - r[2][2], 1.0 - r[0][0] - r[1][1] + r[2][2]};
  const int most = int(std::max_element(squares, squares + 4) - squares);
  const double q = std::sqrt(squares[most]), s = 0.5 / q;
  const double off[3] = {r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]};
  out[most] = 0.5 * q;
  if (most == 0) {
    for (int i = 0; i < 3; ++i) out[i + 1] = off[i] * s;
    return;
  }
  const int i = most - 1, j = (i + 1) % 3, k = (i + 2) % 3;
  out[0] = off[i] * s;
  out[j + 1] = (r[j][i] + r[i][j]) * s;
  out[k + 1] = (r[k][i] + r[i][k]) * s;
}

int read(TrephineDevice* device, double, TrephineArmState* states) {
  if (const int refused = beginExchange(device, states)) return refused;
  Arms& arms = device->arms;
  const Arms::Samples& samples = arms.latest();
  device->given = samples.number;
  for (std::size_t i = 0; i < device->places.size(); ++i) {
    TrephineArmState& state = *element(states, i);
    const double* m = samples.of[i].transform;
    state.sequence = device->given;
    state.time_ns = samples.time_ns;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      state.position_m[axis] = 1e-3 * m[12 + axis] - device->centre_m[i][axis];
    }
    turnOf(m, state.orientation);
    state.buttons = std::uint32_t(samples.of[i].buttons);
    state.flags = TREPHINE_ARM_CALIBRATED;
    if (samples.of[i].in_holder) state.flags |= TREPHINE_ARM_NO_HAND;
    if (arms.warm(i)) state.flags |= TREPHINE_ARM_WARM;
    if (arms.hadError(i)) state.flags |= TREPHINE_ARM_ERROR;
    if (!arms.lost(i)) continue;
    state.flags |= TREPHINE_ARM_LOST;
    device->error = "An OpenHaptics arm reports a fault: check its cable and power, and try again.";
  }
  return TREPHINE_OK;
}

int write(TrephineDevice* device, const TrephineArmCommand* commands) {
  const std::uint32_t silences = device ? device->silence.asked() : 0;
  if (const int refused = beginExchange(device, commands)) return refused;
  std::array<std::array<double, 3>, kMostArms> forces_N{};
  bool refused = false;
  for (std::size_t i = 0; i < device->places.size(); ++i) {
    const double* force_N = element(commands, i)->force_N;
    if (finite(force_N, 3)) {
      std::copy_n(force_N, 3, forces_N[i].begin());
    } else {
      refused = true;
    }
  }
  device->arms.command(forces_N);
  return endWrite(device, silences, commands, device->places.size(), refused);
}

int wait(TrephineDevice* device, double timeout_s) {
  if (!device || !device->running || !(timeout_s >= 0.0)) return TREPHINE_ERROR_ARGUMENT;
  return device->arms.waitForOther(device->given, std::min(timeout_s, 1.0))
             ? TREPHINE_OK
             : TREPHINE_ERROR_TIMEOUT;
}

int stop(TrephineDevice* device) {
  if (!device) return TREPHINE_ERROR_ARGUMENT;
  device->running = false;
  device->arms.stop();
  return TREPHINE_OK;
}

// The next frame sends zero.
void safeStop(TrephineDevice* device) {
  if (device) device->silence.ask();
}

const char* lastError(TrephineDevice* device) {
  return device ? device->error : open_error.c_str();
}

void close(TrephineDevice* device) {
  if (!device) return;
  stop(device);
  delete device;
  in_use = false;
}

const TrephineDeviceApi kApi = {sizeof(TrephineDeviceApi),
                                TREPHINE_DEVICE_ABI,
                                "openhaptics",
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
