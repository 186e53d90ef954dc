#include "exercise/rig.h"

#include <algorithm>

#include "base/system.h"
#include "exercise/exercise.h"

namespace trephine {

std::string usualArmFile() {
  return (resourceFolder() / "devices" / "omni.json").string();
}

Rig simulatedRig(const Exercise& exercise) {
  Rig rig;
  addSimulatedArms(rig, exercise.arms.size());
  return rig;
}

void addSimulatedArms(Rig& rig, std::size_t arms) {
  rig.arms.resize(std::max(arms, rig.arms.size()));
  std::uint32_t place = 0;
  for (Rig::Arm& arm : rig.arms) {
    if (!arm.device.plugin.empty()) continue;
    const auto taken = [&](const Rig::Arm& other) {
      return other.device.plugin == kSimulated && other.device.place == place;
    };
    while (std::ranges::any_of(rig.arms, taken)) ++place;
    arm.device = {kSimulated, place, usualArmFile()};
  }
}

}  // namespace trephine
