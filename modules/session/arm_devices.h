// The devices that move a scene's arms, and what they say of those arms.
#pragma once

#include <vector>

#include "base/result.h"
#include "haptics/haptic_loop.h"
#include "scene/scene.h"

namespace trephine {

// Opens one device a plugin, holding all of the scene's arms that it moves, without starting it.
// `capabilities` has one an arm afterwards; the arms' dynamics and their force limits [N] are those
// of the devices. Errors: those of the devices, BAD_SCENE where a device cannot do what the scene
// asks of it. Any thread that has them alone.
Status openDevices(Scene& scene, std::vector<LoopDevice>& devices,
                   std::vector<TrephineCapabilities>& capabilities);

// Asks the plugins of the scene's arms what those arms are, without starting them: fills in the
// arms' dynamics, with the most that the devices give; what the scene asks for stays. Errors: as
// above.
Status readArmDynamics(Scene& scene);

// How far each arm reaches: the full extents of its workspace, device axes, mm. Errors: as above.
Result<std::vector<Vec3>> readWorkspaces(Scene scene);

}  // namespace trephine
