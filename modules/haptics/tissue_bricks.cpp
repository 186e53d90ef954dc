#include "haptics/tissue_bricks.h"

#include <algorithm>

namespace trephine {

namespace {
constexpr std::size_t kBricksSearched = 4096;  // for one to recount, a tick
}

TissueBricks::TissueBricks(const Grid& grid, const TissueLookup& lookup)
    : size_(grid.geometry().size), solid_(size_) {
  for (int axis = 0; axis < 3; ++axis) bricks_[axis] = (size_[axis] + kBrickEdge - 1) / kBrickEdge;
  count_.assign(std::size_t(bricks_[0]) * std::size_t(bricks_[1]) * std::size_t(bricks_[2]), {});
  // In the order of memory: half the time of brick after brick.
  std::size_t voxel = 0;
  for (int k = 0; k < size_[2]; ++k) {
    for (int j = 0; j < size_[1]; ++j) {
      const std::size_t row = at(0, j >> kBrickShift, k >> kBrickShift);
      for (int i = 0; i < size_[0]; ++i, ++voxel) {
        const int c = lookup.classAt(grid, voxel);
        if (c < 0) continue;
        Brick& brick = count_[row + std::size_t(i >> kBrickShift)];
        ++brick.tissue;
        if (!lookup.isSolid(c)) continue;
        ++brick.solid;
        solid_.set({i, j, k}, true);
      }
    }
  }
}

void TissueBricks::findSolid(const Grid& grid, const TissueLookup& lookup) {
  for (std::size_t brick = 0; brick < count_.size(); ++brick) (void)tissueIn(brick, grid, lookup);
  solid_known_ = true;
}

// Sets the bits of its voxels too.
TissueBricks::Brick TissueBricks::tissueIn(std::size_t brick, const Grid& grid,
                                           const TissueLookup& lookup) {
  const GridGeometry& g = grid.geometry();
  const std::size_t row = brick / std::size_t(bricks_[0]);
  const int from[3] = {int(brick % std::size_t(bricks_[0])) << kBrickShift,
                       int(row % std::size_t(bricks_[1])) << kBrickShift,
                       int(row / std::size_t(bricks_[1])) << kBrickShift};
  int to[3];
  for (int axis = 0; axis < 3; ++axis) to[axis] = std::min(from[axis] + kBrickEdge, size_[axis]);
  Brick count;
  for (int k = from[2]; k < to[2]; ++k) {
    for (int j = from[1]; j < to[1]; ++j) {
      const std::size_t first = g.indexOf(from[0], j, k);
      for (int i = from[0]; i < to[0]; ++i) {
        const int c = lookup.classAt(grid, first + std::size_t(i - from[0]));
        const bool solid = lookup.isSolid(c);
        solid_.set({i, j, k}, solid);
        count.tissue += c >= 0;
        count.solid += solid;
      }
    }
  }
  return count;
}

void TissueBricks::recount(const Grid& grid, const TissueLookup& lookup) {
  const std::size_t searched = unknown_ == 0 ? 0 : std::min(kBricksSearched, count_.size());
  for (std::size_t n = 0; n < searched && unknown_ > 0; ++n) {
    const std::size_t brick = next_;
    next_ = next_ + 1 == count_.size() ? 0 : next_ + 1;
    if (count_[brick].tissue != kUnknown) continue;
    count_[brick] = tissueIn(brick, grid, lookup);
    if (--unknown_ == 0) solid_known_ = true;
    return;
  }
}

}  // namespace trephine
