// Which parts of a volume a ray may leap over, at a resolution of 8^3 voxels. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "render/transfer_function.h"
#include "volume/grid.h"
#include "volume/label_map.h"

namespace trephine {

constexpr int kLeapEdge = 8;

// Bricks [low, high) on each axis.
using BrickBox = VoxelBox;

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

  // After voxels in `box` changed: the box of bricks whose range did, if any.
  std::optional<BrickBox> update(const Volume& volume, const VoxelBox& box);

  const Index3& size() const { return size_; }
  std::size_t indexOf(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(size_[1]) + std::size_t(j)) * std::size_t(size_[0]) +
           std::size_t(i);
  }
  const std::vector<Range>& ranges() const { return ranges_; }
  Range whole() const;

 private:
  Index3 size_{0, 0, 0};  // bricks
  std::vector<Range> ranges_;
};

// Which labels the voxels of each 8^3 brick have; none (0) until they were looked at. A ray takes
// the label of the voxel it is in, so that what lies beyond a brick does not count.
class BrickLabels {
 public:
  BrickLabels() = default;
  explicit BrickLabels(const Index3& voxels);

  // After labels in `box` were set or changed.
  void update(const LabelMap& labels, const VoxelBox& box);

  const Index3& voxels() const { return voxels_; }
  // The rows of these labels, a bit a row, of each brick and of one.
  std::vector<std::uint32_t> rows(const LabelRows& rows) const;
  std::uint32_t rowsOf(std::size_t brick, const LabelRows& rows) const;

 private:
  using Labels = std::array<std::uint64_t, 4>;  // a bit a label
  Index3 voxels_{0, 0, 0}, size_{0, 0, 0};
  std::vector<Labels> labels_;
};

// One byte a brick, i fastest: 0 where a visible HU can be met, else at most the number of bricks
// (in the largest of the three axes, up to 255) to the nearest brick where one can. From a brick
// with n a ray may leap to the faces of the cube of 2n - 1 bricks around it.
// Maps and boxes are on the grid of the constructor; where other HU become visible, another one is
// made. setRows() comes before update() of that brick.
class EmptySpaceDistance {
 public:
  EmptySpaceDistance() = default;
  // `margin_HU` widens the intervals, for a lookup table whose entries smear.
  EmptySpaceDistance(const BrickRanges& bricks, std::vector<HuInterval> visible, double margin_HU);
  // The same where each row of labels has its own visible HU; `rows`: BrickLabels::rows().
  EmptySpaceDistance(const BrickRanges& bricks, std::vector<std::vector<HuInterval>> visible_by_row,
                     std::vector<std::uint32_t> rows, double margin_HU);

  // After the ranges in `changed` did. Only the bricks around them are looked at, so that a cut
  // costs the same in any volume; distances stay true, but where matter went they may stay short.
  void update(const BrickRanges& bricks, const BrickBox& changed);
  // The same after a brick has other rows, with update() of it.
  void setRows(std::size_t brick, std::uint32_t rows) {
    if (!rows_.empty()) rows_[brick] = rows;
  }

  const std::vector<std::uint8_t>& distances() const { return distances_; }

 private:
  bool visible(const BrickRanges& bricks, std::size_t brick) const;

  std::vector<std::vector<HuInterval>> visible_;  // by row
  std::vector<std::uint32_t> rows_;               // of each brick; empty: all of the first
  std::vector<std::uint8_t> distances_;
};

}  // namespace trephine
