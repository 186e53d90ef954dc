// The arms of this workstation, as its settings have them: which device is the left and which the
// right, and how much force they may give at most.
#pragma once

#include <optional>
#include <string>

#include "desk/arms_here.h"
#include "device/find_arms.h"

namespace trephine {

ArmSettings armSettings();
void chooseArm(const std::string& arm, const std::optional<FoundArm>& device);

}  // namespace trephine
