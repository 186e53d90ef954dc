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

struct DeviceConfig {
  std::vector<ArmConfig> arms;   // one an opened arm
  double vanish_after_s = -1.0;  // simulated time at which the device goes away; negative: never
  double block_after_s = -1.0;   // simulated time at which an exchange blocks once; negative: never
  double block_for_s = 0.0;      // for so long, of the host's time
};

// Reads `text` for `n_arms` opened arms. False with one sentence in `error` that names the field
// and its value: not JSON, another format or a newer version, an unknown or missing field, a wrong
// type, an impossible number, a number without source, too few or too many arms.
bool parseConfig(const char* text, std::size_t n_arms, DeviceConfig& config, std::string& error);

}  // namespace trephine::simulated
