// How many voxels of tissue each 16^3 brick of the grid may hold, and how many of them are solid:
// where none, a tool does not look at its voxels. Counted before the first tick, less one for every
// voxel that is removed. A brick that became unknown is counted anew, one a tick. And which voxels
// are solid.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "haptics/solid_bits.h"
#include "haptics/tissue_lookup.h"
#include "volume/grid.h"

namespace trephine {

class TissueBricks {
 public:
  TissueBricks(const Grid& grid, const TissueLookup& lookup);
  // Other HU mean tissue from now on: every brick may hold some. No allocation.
  void markAll() {
    std::fill(count_.begin(), count_.end(), kUnknownBrick);
    unknown_ = count_.size();
    solid_known_ = false;
  }
  // Tissue came back, or went again, in this brick of the grid.
  void mark(std::size_t brick) {
    if (count_[brick].tissue != kUnknown) ++unknown_;
    count_[brick] = kUnknownBrick;
  }
  // Counts the next brick of which nothing is known, if one is near. No allocation.
  void recount(const Grid& grid, const TissueLookup& lookup);
  std::size_t unknown() const { return unknown_; }  // bricks

  // The solid voxels; null after markAll() until every brick was counted anew.
  const SolidBits* solid() const { return solid_known_ ? &solid_ : nullptr; }
  // Looks at every voxel: not for the tick.
  void findSolid(const Grid& grid, const TissueLookup& lookup);
  // A voxel that came back or went again is solid now, or not.
  void setSolid(const Index3& voxel, bool solid) { solid_.set(voxel, solid); }

  void remove(const Index3& voxel, bool solid) {
    solid_.set(voxel, false);
    Brick& brick =
        count_[at(voxel[0] >> kBrickShift, voxel[1] >> kBrickShift, voxel[2] >> kBrickShift)];
    if (brick.tissue == kUnknown) return;
    if (brick.tissue > 0) --brick.tissue;
    if (solid && brick.solid > 0) --brick.solid;
  }

  // Whether there may be tissue in a box of voxels, its bounds included. False for bounds that are
  // not numbers.
  bool mayHold(const Vec3& low, const Vec3& high) const {
    return anyIn(low, high, [](const Brick& brick) { return brick.tissue > 0; });
  }
  bool mayHoldSolid(const Vec3& low, const Vec3& high) const {
    return anyIn(low, high, [](const Brick& brick) { return brick.solid > 0; });
  }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.count_);
    archive.within(self.next_, 0, std::int64_t(self.count_.size()));
    if constexpr (Archive::kReads) {
      self.unknown_ =
          std::size_t(std::count_if(self.count_.begin(), self.count_.end(),
                                    [](const Brick& brick) { return brick.tissue == kUnknown; }));
    }
  }

 private:
  struct Brick {
    std::uint16_t tissue = 0, solid = 0;  // voxels

    template <class Self, class Archive>
    static void visitState(Self& self, Archive& archive) {
      archive(self.tissue, self.solid);
    }
  };
  static constexpr std::uint16_t kUnknown = 65535;
  static constexpr Brick kUnknownBrick{kUnknown, kUnknown};

  template <class Holds>
  bool anyIn(const Vec3& low, const Vec3& high, Holds holds) const {
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
          if (holds(count_[at(i, j, k)])) return true;
        }
      }
    }
    return false;
  }
  Brick tissueIn(std::size_t brick, const Grid& grid, const TissueLookup& lookup);
  std::size_t at(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(bricks_[1]) + std::size_t(j)) * std::size_t(bricks_[0]) +
           std::size_t(i);
  }

  Index3 size_;
  Index3 bricks_;
  std::vector<Brick> count_;
  std::size_t unknown_ = 0;
  std::size_t next_ = 0;  // to be recounted, if it is unknown
  // They follow from the grid, and are no part of the state.
  SolidBits solid_;
  bool solid_known_ = true;
};

}  // namespace trephine
