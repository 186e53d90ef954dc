// Which parts of a volume a ray may leap over, at a resolution of 8^3 voxels.
#pragma once

#include <cstdint>
#include <vector>

#include "render/transfer_function.h"
#include "volume/grid.h"

namespace trephine {

constexpr int kLeapEdge = 8;

// The lowest and highest HU that a ray can meet in each 8^3 brick. Interpolation between voxel
// centres reaches one voxel beyond the brick, so that voxel counts too.
class BrickRanges {
 public:
  struct Range {
    std::int16_t low;
    std::int16_t high;
    friend bool operator==(const Range&, const Range&) = default;
  };

  BrickRanges() = default;
  explicit BrickRanges(const Volume& volume);

  // After voxels in `box` changed. True when a brick's range did.
  bool update(const Volume& volume, const VoxelBox& box);

  const Index3& size() const { return size_; }
  const std::vector<Range>& ranges() const { return ranges_; }
  Range whole() const;

 private:
  Index3 size_{0, 0, 0};  // bricks
  std::vector<Range> ranges_;
};

// One byte a brick, i fastest: 0 where a visible HU can be met, else the number of bricks (in
// the largest of the three axes, up to 255) to the nearest brick where one can. From a brick with n
// a ray may leap to the faces of the cube of 2n - 1 bricks around it. `margin_HU` widens the
// intervals, for a lookup table whose entries smear.
std::vector<std::uint8_t> leapDistances(const BrickRanges& bricks,
                                        const std::vector<HuInterval>& visible, double margin_HU);

}  // namespace trephine
