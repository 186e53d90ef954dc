// Boxes of changed voxels on their way to the GPU.
#pragma once

#include <vector>

#include "volume/grid.h"

namespace trephine {

// The same voxels in fewer boxes: two are joined where their common box holds hardly more than
// both. Sending a little too much is cheaper than a call for each brick. Boxes that repeat vanish.
// At most `max_boxes` (at least 1) come back.
std::vector<VoxelBox> mergeBoxes(const std::vector<VoxelBox>& boxes, std::size_t max_boxes = 32);

// The smallest box that holds both.
VoxelBox commonBox(const VoxelBox& a, const VoxelBox& b);
std::size_t voxelCount(const VoxelBox& box);

}  // namespace trephine
