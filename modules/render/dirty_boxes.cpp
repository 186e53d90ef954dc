#include "render/dirty_boxes.h"

#include <algorithm>

namespace trephine {

VoxelBox commonBox(const VoxelBox& a, const VoxelBox& b) {
  VoxelBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::min(a.low[axis], b.low[axis]);
    box.high[axis] = std::max(a.high[axis], b.high[axis]);
  }
  return box;
}

std::size_t voxelCount(const VoxelBox& box) {
  std::size_t count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    count *= std::size_t(std::max(0, box.high[axis] - box.low[axis]));
  }
  return count;
}

std::vector<VoxelBox> mergeBoxes(const std::vector<VoxelBox>& boxes, std::size_t max_boxes) {
  std::vector<VoxelBox> merged;
  // Grows as boxes remain, so that the list stays short however scattered the changes are.
  double slack = 1.25;
  const auto absorb = [&](VoxelBox box) {
    for (std::size_t i = 0; i < merged.size();) {
      const VoxelBox both = commonBox(box, merged[i]);
      const double apart = double(voxelCount(box) + voxelCount(merged[i]));
      if (double(voxelCount(both)) <= slack * apart) {
        box = both;
        merged[i] = merged.back();
        merged.pop_back();
        i = 0;  // the larger box may now meet one that was passed over
      } else {
        ++i;
      }
    }
    merged.push_back(box);
  };
  const auto shrink = [&] {
    while (merged.size() > std::max<std::size_t>(1, max_boxes)) {
      slack *= 2.0;
      std::vector<VoxelBox> again;
      again.swap(merged);
      for (const VoxelBox& box : again) absorb(box);
    }
  };
  for (const VoxelBox& box : boxes) {
    if (voxelCount(box) == 0) continue;
    absorb(box);
    if (merged.size() > 4 * max_boxes) shrink();
  }
  shrink();
  return merged;
}

}  // namespace trephine
