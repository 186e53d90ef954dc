// Which 16^3 bricks of the grid may hold tissue: what lies in others alone is air, and a tool there
// needs no look at its voxels. Made once, before the first tick; removal leaves a brick marked.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "haptics/tissue_lookup.h"
#include "volume/grid.h"

namespace trephine {

class TissueBricks {
 public:
  TissueBricks(const Grid& grid, const TissueLookup& lookup);
  // Other HU mean tissue from now on: every brick may hold some. No allocation.
  void markAll() { std::fill(marked_.begin(), marked_.end(), std::uint8_t(1)); }

  // Whether there may be tissue in a box of voxels, its bounds included. False for bounds that are
  // not numbers.
  bool mayHold(const Vec3& low, const Vec3& high) const {
    int from[3], to[3];
    for (int axis = 0; axis < 3; ++axis) {
      if (!(high[axis] >= -1.0 && low[axis] <= size_[axis])) return false;
      from[axis] = low[axis] > 0.0 ? int(low[axis]) >> kBrickShift : 0;
      const double last = size_[axis] - 1;
      to[axis] = int(std::max(0.0, std::min(high[axis] + 1.0, last))) >> kBrickShift;
    }
    for (int k = from[2]; k <= to[2]; ++k) {
      for (int j = from[1]; j <= to[1]; ++j) {
        for (int i = from[0]; i <= to[0]; ++i) {
          if (marked_[(std::size_t(k) * std::size_t(bricks_[1]) + std::size_t(j)) *
                          std::size_t(bricks_[0]) +
                      std::size_t(i)]) {
            return true;
          }
        }
      }
    }
    return false;
  }

 private:
  Index3 size_;
  Index3 bricks_;
  std::vector<std::uint8_t> marked_;
};

}  // namespace trephine
