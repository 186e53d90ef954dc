// Foot switches and SpaceMice behind the C ABI: arguments, configuration, states. Their reports are
// input.h, the hand that a SpaceMouse stands for hand.h.
#include "../common/plugin.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hand.h"
#include "input.h"
#include "trephine_device.h"

using namespace trephine::pedal;
using namespace trephine::plugin;

namespace {

constexpr std::uint32_t kMostArms = 8;
constexpr double kRate_hz = 20000.0;  // the host paces them
constexpr double kMaxStep_s = 0.1;    // longer steps are refused: they would block

struct Arm {
  Input input;
  VirtualArm held;   // of a SpaceMouse
  Vector force_N{};  // written last
  std::uint64_t sequence = 0;
  std::int64_t time_ns = 0;
  bool isPedal() const { return input.found().kind == Kind::foot_switch; }
};

thread_local std::string open_error;

}  // namespace

struct TrephineDevice : trephine::plugin::Opened {
  std::vector<std::unique_ptr<Arm>> arms;
  HandConfig hand;
};

namespace {

uint32_t enumerate(TrephineArmInfo* infos, uint32_t capacity) try {
  open_error.clear();
  const std::vector<Found> inputs = findInputs();
  for (std::uint32_t i = 0; infos && i < capacity && i < inputs.size(); ++i) {
    TrephineArmInfo* info = element(infos, i);
    if (infos->size < sizeof(TrephineArmInfo)) break;
    std::snprintf(info->bus_path, sizeof(info->bus_path), "usb-%s", inputs[i].port.c_str());
    std::snprintf(info->serial, sizeof(info->serial), "%s", inputs[i].serial.c_str());
    std::snprintf(info->model, sizeof(info->model), "%s", inputs[i].model.c_str());
  }
  return std::uint32_t(inputs.size());
} catch (const std::exception&) {
  return 0;
}

int open(const uint32_t* places, uint32_t n_arms, TrephineDevice** out) try {
  if (!out) return TREPHINE_ERROR_ARGUMENT;
  *out = nullptr;
  if (!places || n_arms == 0 || n_arms > kMostArms) {
    open_error = "Of foot switches and SpaceMice, one to " + std::to_string(kMostArms) +
                 " are opened together.";
    return TREPHINE_ERROR_ARGUMENT;
  }
  const std::vector<Found> inputs = findInputs();
  auto device = std::make_unique<TrephineDevice>();
  for (std::uint32_t i = 0; i < n_arms; ++i) {
    if (places[i] >= inputs.size()) {
      open_error = "There is no foot switch or SpaceMouse " + std::to_string(places[i]) + ": " +
                   std::to_string(inputs.size()) + " are plugged in.";
      return TREPHINE_ERROR_NO_DEVICE;
    }
    if (std::count(places, places + i, places[i]) > 0) {
      open_error =
          "Foot switch or SpaceMouse " + std::to_string(places[i]) + " is asked for twice.";
      return TREPHINE_ERROR_ARGUMENT;
    }
    device->arms.push_back(std::make_unique<Arm>());
    std::string why = device->arms.back()->input.open(inputs[places[i]]);
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

// What a configuration may have beside format, version and model.
struct HandNumber {
  const char* key;
  double low, high;
  double HandConfig::*member;
};
constexpr HandNumber kHandNumbers[] = {{"speed_m_s", 0.001, 1.0, &HandConfig::speed_m_s},
                                       {"turn_rad_s", 0.01, 10.0, &HandConfig::turn_rad_s},
                                       {"dead_zone", 0.0, 0.9, &HandConfig::dead_zone}};

// {"format": "trephine.device", "version": 1, "model": text} and the numbers above, which may be
// absent. Empty, or what is wrong with it.
std::string parse(const char* text, HandConfig& into) {
  const auto root = nlohmann::json::parse(text, nullptr, false);
  if (!root.is_object()) return "The text is no JSON object.";
  HandConfig hand;
  for (const auto& [key, value] : root.items()) {
    if (key == "format" || key == "version" || key == "model") continue;
    const auto number =
        std::find_if(std::begin(kHandNumbers), std::end(kHandNumbers),
                     [&name = key](const HandNumber& of) { return name == of.key; });
    if (number == std::end(kHandNumbers)) {
      return "Field '" + key + "': unknown; remove it or correct its name.";
    }
    if (!value.is_number() || !(value >= number->low && value <= number->high)) {
      char range[80];
      std::snprintf(range, sizeof(range), "expected a number from %g to %g.", number->low,
                    number->high);
      return "Field '" + key + "': " + range;
    }
    hand.*(number->member) = value;
  }
  if (root.value("format", nlohmann::json()) != "trephine.device") {
    return "Field 'format': it must be 'trephine.device'.";
  }
  if (root.value("version", nlohmann::json()) != 1) return "Field 'version': this plugin reads 1.";
  if (!root.value("model", nlohmann::json()).is_string()) return "Field 'model': expected text.";
  into = hand;
  return {};
}

int configure(TrephineDevice* device, const char* json) try {
  if (!device || !json) return TREPHINE_ERROR_ARGUMENT;
  if (device->running) {
    return fail(device, TREPHINE_ERROR_STATE, "The arms are running: stop them to configure them.");
  }
  std::string wrong = parse(json, device->hand);
  if (!wrong.empty()) return failWith(device, TREPHINE_ERROR_ARGUMENT, std::move(wrong));
  device->configured = true;
  return TREPHINE_OK;
} catch (const std::exception& e) {
  return failWith(device, TREPHINE_ERROR_ARGUMENT, e.what());
}

int capabilities(TrephineDevice* device, uint32_t place, TrephineCapabilities* out) {
  if (!device || !out || out->size < sizeof(TrephineCapabilities)) return TREPHINE_ERROR_ARGUMENT;
  if (place >= device->arms.size()) {
    return fail(device, TREPHINE_ERROR_ARGUMENT, "There is no opened arm of that number.");
  }
  const Arm& arm = *device->arms[place];
  const std::uint32_t size = out->size, version = out->version;
  *out = TrephineCapabilities{};
  out->size = size;
  out->version = version;
  out->rate_hz = kRate_hz;
  if (arm.isPedal()) return TREPHINE_OK;
  const trephine::simulated::ArmParameters& of = arm.held.parameters;
  out->input_dof = 6;
  std::copy(of.workspace_m.begin(), of.workspace_m.end(), out->workspace_m);
  out->peak_force_N = out->continuous_force_N = of.peak_force_N;  // it has no motors to warm
  out->apparent_mass_kg = of.mass_kg;
  out->encoder_step_m = of.encoder_step_m;
  return TREPHINE_OK;
}

int calibrate(TrephineDevice* device, uint32_t place) {
  if (!device) return TREPHINE_ERROR_ARGUMENT;
  if (place < device->arms.size()) return TREPHINE_OK;  // it starts where it says
  return fail(device, TREPHINE_ERROR_ARGUMENT, "There is no opened arm of that number.");
}

int start(TrephineDevice* device) try {
  if (!device) return TREPHINE_ERROR_ARGUMENT;
  if (!device->configured || device->running) {
    return fail(
        device, TREPHINE_ERROR_STATE,
        device->running ? "The arms are already running." : "The arms have no configuration yet.");
  }
  for (const auto& arm : device->arms) {
    if (!arm->input.lost()) continue;
    const Found& found = arm->input.found();
    return failWith(device, TREPHINE_ERROR_NO_DEVICE,
                    "The " + found.model + " on USB port " + found.port +
                        " went away: plug it in and try again.");
  }
  device->silence.answer(device->silence.asked());
  for (const auto& arm : device->arms) {
    arm->force_N = arm->held.motion.velocity_m_s = {};
  }
  device->running = true;
  return TREPHINE_OK;
} catch (const std::exception& e) {
  return failWith(device, TREPHINE_ERROR_DEVICE, e.what());
}

void report(const Arm& arm, TrephineArmState& state) {
  const VirtualArm& held = arm.held;
  const Vector position = encoderReading(held.parameters, held.motion.position_m);
  state.sequence = arm.sequence;
  state.time_ns = arm.time_ns;
  std::copy(position.begin(), position.end(), state.position_m);
  std::copy(held.orientation.begin(), held.orientation.end(), state.orientation);
  state.buttons = arm.input.buttons();
  state.flags = TREPHINE_ARM_CALIBRATED;
  if (held.motion.at_limit) state.flags |= TREPHINE_ARM_AT_LIMIT;
}

int read(TrephineDevice* device, double dt_s, TrephineArmState* states) {
  if (const int refused = beginExchange(device, states)) return refused;
  if (!(dt_s > 0.0 && dt_s <= kMaxStep_s)) {
    return fail(device, TREPHINE_ERROR_ARGUMENT,
                "The time step must be above 0 and at most 0.1 s.");
  }
  const bool silenced = device->silence.holds();
  for (std::size_t i = 0; i < device->arms.size(); ++i) {
    Arm& arm = *device->arms[i];
    TrephineArmState& state = *element(states, i);
    const bool lost = arm.input.lost();
    if (!lost) {
      // They send what changes and nothing at rest: while it is there, what it said last holds.
      ++arm.sequence;
      arm.time_ns = now_ns();
      if (!arm.isPedal()) {
        const Cap cap = arm.input.cap();
        advance(arm.held, speedOf(device->hand, cap), turnOf(device->hand, cap),
                silenced ? Vector{} : arm.force_N, dt_s);
      }
    }
    report(arm, state);
    if (!lost) continue;
    // The others go on, so it is the arm that is lost and not the reading; nobody presses it now.
    state.flags |= TREPHINE_ARM_LOST;
    state.buttons = 0;
    device->error = "A foot switch or SpaceMouse went away: check its plug and try again.";
  }
  return TREPHINE_OK;
}

int write(TrephineDevice* device, const TrephineArmCommand* commands) {
  const std::uint32_t silences = device ? device->silence.asked() : 0;
  if (const int refused = beginExchange(device, commands)) return refused;
  bool refused = false;
  for (std::size_t i = 0; i < device->arms.size(); ++i) {
    const double* force_N = element(commands, i)->force_N;
    const bool usable = finite(force_N, 3);
    refused = refused || !usable;
    device->arms[i]->force_N = usable ? Vector{force_N[0], force_N[1], force_N[2]} : Vector{};
  }
  return endWrite(device, silences, commands, device->arms.size(), refused);
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
  return device ? device->error : open_error.c_str();
}

void close(TrephineDevice* device) {
  delete device;
}

const TrephineDeviceApi kApi = {sizeof(TrephineDeviceApi),
                                TREPHINE_DEVICE_ABI,
                                "pedal",
                                enumerate,
                                open,
                                configure,
                                capabilities,
                                calibrate,
                                start,
                                read,
                                write,
                                nullptr,  // the host paces them
                                nullptr,  // the cap moves the hand, not the host
                                stop,
                                safeStop,
                                lastError,
                                close};

}  // namespace

extern "C" __attribute__((visibility("default"))) const TrephineDeviceApi* trephine_device_plugin(
    std::uint32_t host_abi) {
  return host_abi == TREPHINE_DEVICE_ABI ? &kApi : nullptr;
}
