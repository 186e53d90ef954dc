// What moves an exercise's arms on a workstation. An exercise says nothing of it; a recording keeps
// what it was.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "haptics/arm_dynamics.h"

namespace trephine {

struct Exercise;

inline constexpr const char* kSimulated = "simulated";

// A device, or one arm of it.
struct ArmDevice {
  std::string plugin;       // kSimulated, or the name of a plugin in pluginFolder()
  std::uint32_t place = 0;  // in the plugin's enumeration
  std::string config;       // file of the plugin's configuration, empty for none
  bool operator==(const ArmDevice&) const = default;
};

struct Rig {
  struct Arm {
    ArmDevice device;
    std::optional<ArmDynamics> dynamics;  // once the device was asked
    bool operator==(const Arm&) const = default;
  };
  std::vector<Arm> arms;  // one for each arm of the exercise, in its order
  std::optional<ArmDevice> pedal;
  bool operator==(const Rig&) const = default;
};

// What a simulated arm is like where nobody says otherwise: its plugin's configuration.
std::string usualArmFile();

// A simulated arm each, in the places 0, 1, ...
Rig simulatedRig(const Exercise& exercise);

// Gives arms of `rig` that have no device, and those that it lacks, a simulated one that no other
// arm has.
void addSimulatedArms(Rig& rig, std::size_t arms);

}  // namespace trephine
