// The arms of this workstation, as its settings have them: which device is the left and which the
// right, and how much force they may give at most.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "device/find_arms.h"
#include "scene/scene.h"

namespace trephine {

// By the exercise's name of an arm, "left" or "right"; one that is absent is simulated. And kPedal.
using ArmsOfPlace = std::map<std::string, FoundArm>;

ArmsOfPlace armsOfThisPlace();
void chooseArm(const std::string& arm, const std::optional<FoundArm>& device);

// The scene's arms of these names moved by these devices, the others simulated. It asks what is
// plugged in: not on the window's thread. Errors: those of deviceOf() and rigWith().
Result<Rig> rigOf(const Scene& scene, const ArmsOfPlace& chosen);

// No arm gives more than the settings allow.
Scene withForceLimit(Scene scene);

}  // namespace trephine
