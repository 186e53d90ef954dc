// The configuration of the simulated arms: JSON text, format "trephine.device", version 1. Every
// field is described in README.md; resources/devices/omni.json is one.
#pragma once

#include <cstddef>
#include <vector>

#include "simulated_arm.h"
#include "trephine_device.h"

namespace trephine::simulated {

struct ArmConfig {
  ArmParameters parameters;
  TrephineCapabilities capabilities{};
};

// A number of an arm in one row: what the file may say, and where it goes. README.md's table is
// made from these rows, and a test holds them against what the host takes.
struct ArmNumber {
  const char* key;
  const char* unit;
  double low, high;   // both ends are allowed
  std::size_t count;  // 3: along x, y and z
  void (*set)(ArmConfig& arm, const double* values);
  const char* meaning;
  bool optional = false;  // without it: 0
};

inline constexpr ArmNumber kArmNumbers[] = {
    {"apparent_mass_kg", "kg", 1e-4, 100.0, 1,
     [](ArmConfig& arm, const double* v) {
       arm.parameters.mass_kg = arm.capabilities.apparent_mass_kg = *v;
     },
     "at the tip"},
    {"plant_damping_Ns_per_m", "N s/m", 0.0, 1e6, 1,
     [](ArmConfig& arm, const double* v) { arm.parameters.damping_Ns_per_m = *v; },
     "the arm's own"},
    {"encoder_step_m", "m", 0.0, 0.01, 1,
     [](ArmConfig& arm, const double* v) {
       arm.parameters.encoder_step_m = arm.capabilities.encoder_step_m = *v;
     },
     "0 (reads exactly) or at least 1e-9"},
    {"workspace_m", "m", 1e-3, 10.0, 3,
     [](ArmConfig& arm, const double* v) {
       for (std::size_t axis = 0; axis < 3; ++axis) {
         arm.parameters.workspace_m[axis] = arm.capabilities.workspace_m[axis] = v[axis];
       }
     },
     "extents, centred on the origin"},
    {"peak_force_N", "N", 1e-3, 1000.0, 1,
     [](ArmConfig& arm, const double* v) {
       arm.parameters.peak_force_N = arm.capabilities.peak_force_N = *v;
     },
     "a longer force is shortened to it"},
    {"continuous_force_N", "N", 1e-3, 1000.0, 1,
     [](ArmConfig& arm, const double* v) { arm.capabilities.continuous_force_N = *v; },
     "at most the peak; stated to the host"},
    {"thermal_s", "s", 0.0, 3600.0, 1,
     [](ArmConfig& arm, const double* v) { arm.capabilities.thermal_s = *v; },
     "stated to the host; this arm itself stays cool", true},
    {"latency_s", "s", 0.0, 0.1, 1,
     [](ArmConfig& arm, const double* v) { arm.capabilities.latency_s = *v; },
     "stated to the host; this arm itself takes its force at once", true},
    {"friction_N", "N", 0.0, 10.0, 1,
     [](ArmConfig& arm, const double* v) {
       arm.parameters.friction_N = arm.capabilities.friction_N = *v;
     },
     "the arm's own, dry: what it takes to move it", true},
    {"rate_hz", "Hz", 1.0, 1e6, 1,
     [](ArmConfig& arm, const double* v) { arm.capabilities.rate_hz = *v; },
     "a scene that asks for more is refused"},
};

// What an arm in trouble does, for tests: from when on [s], in simulated time; negative: never.
struct Troubles {
  double vanish_after_s = -1.0;     // the device goes away
  double silent_after_s = -1.0;     // no new sample comes
  double error_after_s = -1.0;      // an error that passes is reported,
  double error_for_s = 0.0;         // for so long
  double warm_after_s = -1.0;       // the motors say that they are warm
  double no_number_after_s = -1.0;  // a pose is not a number
  double block_after_s = -1.0;      // a reading blocks once,
  double block_for_s = 0.0;         // for so long, of the host's time
};

struct TroubleNumber {
  const char* key;
  double Troubles::*member;
  const char* together;  // with this one, or null
  const char* meaning;
};

inline constexpr TroubleNumber kTroubleNumbers[] = {
    {"vanish_after_s", &Troubles::vanish_after_s, nullptr,
     "`read` and `write` then answer `TREPHINE_ERROR_NO_DEVICE` and every state is `LOST`"},
    {"silent_after_s", &Troubles::silent_after_s, nullptr,
     "no new sample comes: `sequence` and pose stay"},
    {"error_after_s", &Troubles::error_after_s, "error_for_s", "every state is marked `ERROR`"},
    {"error_for_s", &Troubles::error_for_s, "error_after_s", "for so long"},
    {"warm_after_s", &Troubles::warm_after_s, nullptr, "every state is marked `WARM`"},
    {"no_number_after_s", &Troubles::no_number_after_s, nullptr, "every position is NaN"},
    {"block_after_s", &Troubles::block_after_s, "block_for_s", "one `read` does not return"},
    {"block_for_s", &Troubles::block_for_s, "block_after_s", "for so long, of the host's clock"},
};

struct DeviceConfig {
  std::vector<ArmConfig> arms;  // one an opened arm
  Troubles troubles;
};

// Reads `text` for `n_arms` opened arms. Throws plugin::Refused with one sentence that names the
// field and its value: not JSON, another format or a newer version, an unknown or missing field, a
// wrong type, an impossible number, a number without source, too few or too many arms.
DeviceConfig parseConfig(const char* text, std::size_t n_arms);

}  // namespace trephine::simulated
