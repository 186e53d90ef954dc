// Phantom and Touch arms behind the C ABI: states, configuration. The maker's library is hd.h, what
// goes on in its scheduler arms.h.
#include "../common/plugin.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "../common/config.h"
#include "arms.h"

using namespace trephine::openhaptics;
using namespace trephine::plugin;

namespace {

struct Config {
  std::vector<std::string> names;
  double rate_hz = 1000.0;
  // As the maker's sheet of the Phantom Omni has them, as remembered; the library does not say.
  double apparent_mass_kg = 0.045, encoder_step_m = 5.5e-5, friction_N = 0.26;
  // The answer goes out in the frame of its sample, and the arm's bus takes a millisecond.
  double latency_s = 0.0015;
};

constexpr NumberOf<Config> kConfigNumbers[] = {
    {"rate_hz", 500.0, 1600.0, &Config::rate_hz},
    {"apparent_mass_kg", 1e-4, 100.0, &Config::apparent_mass_kg},
    {"encoder_step_m", 0.0, 0.01, &Config::encoder_step_m},
    {"latency_s", 0.0, 0.1, &Config::latency_s},
    {"friction_N", 0.0, 10.0, &Config::friction_N},
};

// The maker's scheduler is one a process.
std::atomic<bool> in_use{false};
struct InUse {
  InUse() {
    if (!in_use.exchange(true)) return;
    throw Refused{TREPHINE_ERROR_STATE,
                  "The OpenHaptics arms are in use already: stop the exercise that has them."};
  }
  ~InUse() { in_use = false; }
  InUse(const InUse&) = delete;
};

const Library& library() {
  std::string why;
  const Library* hd = loadLibrary(why);
  if (!hd) throw Refused{TREPHINE_ERROR_NO_DEVICE, std::move(why)};
  return *hd;
}

// README.md has the fields.
Config parse(const char* text, const std::vector<std::uint32_t>& places) {
  std::vector<std::string_view> keys = keysOf(kConfigNumbers);
  keys.push_back("names");
  const Json root = parseConfig(text, keys);
  Config config;
  readNumbers(root, kConfigNumbers, config);
  if (config.rate_hz != 500.0 && config.rate_hz != 1000.0 && config.rate_hz != 1600.0) {
    refuseField("rate_hz", "the maker's scheduler has 500, 1000 or 1600.");
  }
  const Json names = root.value("names", Json::array({""}));
  const std::uint32_t most = *std::max_element(places.begin(), places.end());
  bool words = names.is_array();
  for (const Json& each : names) words = words && each.is_string();
  if (!words || names.size() <= most) {
    refuseField("names", "expected the names of " + std::to_string(most + 1) +
                             " arms, as the maker's set-up has them.");
  }
  for (std::uint32_t place : places) config.names.push_back(names[place]);
  return config;
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

}  // namespace

struct TrephineDevice : Opened {
  static constexpr const char *kName = "openhaptics", *kArm = "OpenHaptics arm";
  static constexpr std::uint32_t kMostArms = trephine::openhaptics::kMostArms;

  InUse alone;
  std::vector<std::uint32_t> places;  // of its arms among the configured names
  Arms arms;
  Config config;
  std::array<std::array<double, 3>, kMostArms> centre_m{};  // of the workspace
  std::uint64_t given = 0;                                  // number of the last sample read

  // The library finds no arms by itself: these are places for the names that a configuration gives.
  static std::vector<std::uint32_t> find() {
    (void)library();
    return {0, 1};
  }
  static void describe(std::uint32_t place, TrephineArmInfo& info) {
    copyText(info.bus_path, "openhaptics-" + std::to_string(place));
    copyText(info.model, "Phantom or Touch");
  }
  explicit TrephineDevice(const std::vector<std::uint32_t>& chosen)
      : places(chosen), arms(library(), silence) {}
  std::size_t size() const { return places.size(); }

  void configure(const char* json);
  void capabilities(std::size_t arm, TrephineCapabilities& out);
  void calibrate(std::size_t arm) { orRefuse(arms.calibrate(arm)); }
  void start() {
    given = 0;
    orRefuse(arms.start(config.rate_hz));
  }
  void stop() { arms.stop(); }

  int read(double, TrephineArmState* states);
  int command(const Forces& forces_N);
  bool waitForOther(double timeout_s) { return arms.waitForOther(given, timeout_s); }

 private:
  static void orRefuse(std::string why) {
    if (!why.empty()) throw Refused{TREPHINE_ERROR_DEVICE, std::move(why)};
  }
};

void TrephineDevice::configure(const char* json) {
  Config read = parse(json, places);
  configured = false;
  std::string why = arms.open(read.names);
  if (!why.empty()) throw Refused{TREPHINE_ERROR_NO_DEVICE, std::move(why)};
  for (std::size_t arm = 0; arm < places.size(); ++arm) {
    const std::array<double, 6> box_mm = arms.workspace_mm(arm);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      centre_m[arm][axis] = 0.5e-3 * (box_mm[axis + 3] + box_mm[axis]);
    }
  }
  config = std::move(read);
}

void TrephineDevice::capabilities(std::size_t arm, TrephineCapabilities& out) {
  out.input_dof = arms.integer(arm, kInputDof) >= 6 ? 6 : 3;
  const std::array<double, 6> box_mm = arms.workspace_mm(arm);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.workspace_m[axis] = 1e-3 * (box_mm[axis + 3] - box_mm[axis]);
  }
  out.peak_force_N = arms.number(arm, kNominalMaxForce);
  out.continuous_force_N = std::min(out.peak_force_N, arms.number(arm, kNominalMaxContinuousForce));
  out.thermal_s = 0.0;  // its driver watches its motors and says so
  out.apparent_mass_kg = config.apparent_mass_kg;
  out.encoder_step_m = config.encoder_step_m;
  out.rate_hz = config.rate_hz;
  out.latency_s = config.latency_s;
  out.friction_N = config.friction_N;
}

int TrephineDevice::read(double, TrephineArmState* states) {
  const Arms::Samples& samples = arms.latest();
  given = samples.number;
  for (std::size_t i = 0; i < places.size(); ++i) {
    TrephineArmState& state = *element(states, i);
    const double* m = samples.of[i].transform;
    state.sequence = given;
    state.time_ns = samples.time_ns;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      state.position_m[axis] = 1e-3 * m[12 + axis] - centre_m[i][axis];
    }
    turnOf(m, state.orientation);
    state.buttons = std::uint32_t(samples.of[i].buttons);
    state.flags = TREPHINE_ARM_CALIBRATED;
    if (samples.of[i].in_holder) state.flags |= TREPHINE_ARM_NO_HAND;
    if (arms.warm(i)) state.flags |= TREPHINE_ARM_WARM;
    if (arms.hadError(i)) state.flags |= TREPHINE_ARM_ERROR;
    if (!arms.lost(i)) continue;
    state.flags |= TREPHINE_ARM_LOST;
    error = "An OpenHaptics arm reports a fault: check its cable and power, and try again.";
  }
  return TREPHINE_OK;
}

int TrephineDevice::command(const Forces& forces_N) {
  std::array<std::array<double, 3>, kMostArms> sent_N{};
  for (std::size_t i = 0; i < kMostArms; ++i) {
    if (forces_N[i]) std::copy_n(forces_N[i], 3, sent_N[i].begin());
  }
  arms.command(sent_N);
  return TREPHINE_OK;
}

extern "C" __attribute__((visibility("default"))) const TrephineDeviceApi* trephine_device_plugin(
    std::uint32_t host_abi) {
  return trephine::plugin::Plugin<TrephineDevice>::table(host_abi);
}
