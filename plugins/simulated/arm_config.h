// The configuration of the simulated arms: JSON text, format "trephine.device", version 1. Every
// field is described in README.md; resources/devices/omni.json is one.
#pragma once

#include <cstddef>
#include <string>
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
     "at most the peak; reported, not enforced"},
    {"max_stiffness_N_per_m", "N/m", 1e-3, 1e9, 1,
     [](ArmConfig& arm, const double* v) { arm.capabilities.max_stiffness_N_per_m = *v; },
     "reported, not enforced"},
    {"max_damping_Ns_per_m", "N s/m", 0.0, 1e9, 1,
     [](ArmConfig& arm, const double* v) { arm.capabilities.max_damping_Ns_per_m = *v; },
     "reported, not enforced"},
    {"rate_hz", "Hz", 1.0, 1e6, 1,
     [](ArmConfig& arm, const double* v) { arm.capabilities.rate_hz = *v; },
     "a scene that asks for more is refused"},
};

struct DeviceConfig {
  std::vector<ArmConfig> arms;   // one an opened arm
  double vanish_after_s = -1.0;  // simulated time at which the device goes away; negative: never
  double block_after_s = -1.0;   // simulated time at which a reading blocks once; negative: never
  double block_for_s = 0.0;      // for so long, of the host's time
};

// Reads `text` for `n_arms` opened arms. False with one sentence in `error` that names the field
// and its value: not JSON, another format or a newer version, an unknown or missing field, a wrong
// type, an impossible number, a number without source, too few or too many arms.
bool parseConfig(const char* text, std::size_t n_arms, DeviceConfig& config, std::string& error);

}  // namespace trephine::simulated
