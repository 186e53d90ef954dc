// What the driver of the OpenGL context that is current allows.
#pragma once

namespace trephine {

// Voxels along the longest edge of a volume that it draws; 0 where it does not say.
int largestVolumeEdge();

}  // namespace trephine
