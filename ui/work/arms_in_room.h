// Where this workstation's arms stand in the room of a headset, as a person registered them.
#pragma once

#include <optional>

#include "base/math.h"
#include "device/find_arms.h"

namespace trephine {

struct ArmInRoom {
  Pose room_from_device_m;
  // To be expected 10 cm from the marks' middle (Registration::error_mm); none: set by hand.
  std::optional<double> error_mm;
  // The headset finds the same room again; else it holds until the headset is switched off.
  bool kept = true;
};

// In the settings of this account, by plugin, bus path and serial (FoundArm::isSame()). Window's
// thread.
std::optional<ArmInRoom> armInRoom(const FoundArm& device);
void setArmInRoom(const FoundArm& device, const std::optional<ArmInRoom>& where);
// All, or those that do not hold any more once a headset is off. True where there were any.
bool forgetArmsInRoom(bool all);

}  // namespace trephine
