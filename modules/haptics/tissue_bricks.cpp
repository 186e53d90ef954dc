#include "haptics/tissue_bricks.h"

namespace trephine {

TissueBricks::TissueBricks(const Grid& grid, const TissueLookup& lookup)
    : size_(grid.geometry().size) {
  for (int axis = 0; axis < 3; ++axis) bricks_[axis] = (size_[axis] + kBrickEdge - 1) / kBrickEdge;
  count_.assign(std::size_t(bricks_[0]) * std::size_t(bricks_[1]) * std::size_t(bricks_[2]), 0);
  std::size_t voxel = 0;
  for (int k = 0; k < size_[2]; ++k) {
    for (int j = 0; j < size_[1]; ++j) {
      const std::size_t row = at(0, j >> kBrickShift, k >> kBrickShift);
      for (int i = 0; i < size_[0]; ++i, ++voxel) {
        if (lookup.classAt(grid, voxel) >= 0) ++count_[row + std::size_t(i >> kBrickShift)];
      }
    }
  }
}

}  // namespace trephine
