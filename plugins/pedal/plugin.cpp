// Foot switches and SpaceMice behind the C ABI: configuration, states. Their reports are input.h,
// the hand that a SpaceMouse stands for hand.h.
#include "../common/plugin.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "../common/config.h"
#include "hand.h"
#include "input.h"

using namespace trephine::pedal;
using namespace trephine::plugin;

namespace {

constexpr double kRate_hz = 20000.0;  // the host paces them
constexpr double kMaxStep_s = 0.1;    // longer steps are refused: they would block

// What a configuration may have beside format, version and model.
constexpr NumberOf<HandConfig> kHandNumbers[] = {
    {"speed_m_s", 0.001, 1.0, &HandConfig::speed_m_s},
    {"turn_rad_s", 0.01, 10.0, &HandConfig::turn_rad_s},
    {"dead_zone", 0.0, 0.9, &HandConfig::dead_zone}};

struct Arm {
  Input input;
  VirtualArm held;   // of a SpaceMouse
  Vector force_N{};  // written last
  std::uint64_t sequence = 0;
  std::int64_t time_ns = 0;
  bool isPedal() const { return input.found().kind == Kind::foot_switch; }
};

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

}  // namespace

struct TrephineDevice : Opened {
  static constexpr const char *kName = "pedal", *kArm = "foot switch or SpaceMouse";
  static constexpr std::uint32_t kMostArms = 8;

  std::vector<std::unique_ptr<Arm>> arms;
  HandConfig hand;

  static std::vector<Found> find() { return findInputs(); }
  static void describe(const Found& input, TrephineArmInfo& info) {
    copyText(info.bus_path, "usb-" + input.port);
    copyText(info.serial, input.serial);
    copyText(info.model, input.model);
  }
  explicit TrephineDevice(const std::vector<Found>& inputs) {
    for (const Found& input : inputs) {
      arms.push_back(std::make_unique<Arm>());
      std::string why = arms.back()->input.open(input);
      if (!why.empty()) throw Refused{TREPHINE_ERROR_NO_DEVICE, std::move(why)};
    }
  }
  std::size_t size() const { return arms.size(); }

  void configure(const char* json) {
    HandConfig read;
    readNumbers(parseConfig(json, keysOf(kHandNumbers)), kHandNumbers, read);
    hand = read;
  }
  void capabilities(std::size_t place, TrephineCapabilities& out) const {
    out.rate_hz = kRate_hz;
    if (arms[place]->isPedal()) return;
    const trephine::simulated::ArmParameters& of = arms[place]->held.parameters;
    out.input_dof = 6;
    std::copy(of.workspace_m.begin(), of.workspace_m.end(), out.workspace_m);
    out.peak_force_N = out.continuous_force_N = of.peak_force_N;  // it has no motors to warm
    out.apparent_mass_kg = of.mass_kg;
    out.encoder_step_m = of.encoder_step_m;
  }
  void calibrate(std::size_t) {}  // it starts where it says
  void start() {
    for (const auto& arm : arms) {
      if (arm->input.lost()) {
        const Found& found = arm->input.found();
        throw Refused{TREPHINE_ERROR_NO_DEVICE, "The " + found.model + " on USB port " +
                                                    found.port +
                                                    " went away: plug it in and try again."};
      }
      arm->force_N = arm->held.motion.velocity_m_s = {};
    }
  }
  void stop() {}

  int read(double dt_s, TrephineArmState* states);
  int command(const Forces& forces_N) {
    for (std::size_t i = 0; i < arms.size(); ++i) {
      arms[i]->force_N = {};
      if (forces_N[i]) std::copy_n(forces_N[i], 3, arms[i]->force_N.begin());
    }
    return TREPHINE_OK;
  }
};

int TrephineDevice::read(double dt_s, TrephineArmState* states) {
  if (!(dt_s > 0.0 && dt_s <= kMaxStep_s)) {
    return fail(this, TREPHINE_ERROR_ARGUMENT, "The time step must be above 0 and at most 0.1 s.");
  }
  const bool silenced = silence.holds();
  for (std::size_t i = 0; i < arms.size(); ++i) {
    Arm& arm = *arms[i];
    TrephineArmState& state = *element(states, i);
    const bool lost = arm.input.lost();
    if (!lost) {
      // They send what changes and nothing at rest: while it is there, what it said last holds.
      ++arm.sequence;
      arm.time_ns = now_ns();
      if (!arm.isPedal()) {
        const Cap cap = arm.input.cap();
        advance(arm.held, speedOf(hand, cap), turnOf(hand, cap), silenced ? Vector{} : arm.force_N,
                dt_s);
      }
    }
    report(arm, state);
    if (!lost) continue;
    // The others go on, so it is the arm that is lost and not the reading; nobody presses it now.
    state.flags |= TREPHINE_ARM_LOST;
    state.buttons = 0;
    error = "A foot switch or SpaceMouse went away: check its plug and try again.";
  }
  return TREPHINE_OK;
}

extern "C" __attribute__((visibility("default"))) const TrephineDeviceApi* trephine_device_plugin(
    std::uint32_t host_abi) {
  return trephine::plugin::Plugin<TrephineDevice>::table(host_abi);
}
