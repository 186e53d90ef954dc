// What the driver of the OpenGL context that is current allows, and what one is.
#pragma once

#include <string>

namespace trephine {

// Voxels along the longest edge of a volume that it draws; 0 where it does not say.
int largestVolumeEdge();
// By processors and not by a card: `driver` is as SceneRenderer::openGlDescription() or
// probedRenderer() has it.
bool isSoftware(const std::string& driver);

}  // namespace trephine
