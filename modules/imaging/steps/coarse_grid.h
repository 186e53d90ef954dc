// A quick look at a large CT: cells of a few millimetres, so that a finding takes milliseconds.
#pragma once

#include <cstdint>
#include <vector>

#include "volume/volume.h"

namespace trephine {

enum CellMark : std::uint8_t {
  kSolidCell = 1,   // none is below -400 HU
  kMatterCell = 2,  // one is over -500 HU: plastic or carbon 1 mm thick has it
  kBoneCell = 4,    // one is over 600 HU: of couches, only metal has it
};

// Cells lie in axes a, b, s: s is the grid axis nearest to the patient's head-foot axis (the axis
// of a couch), a and b the other two, a the faster one in memory. A cell spans step[0] x step[1]
// voxels across, of which at most eight lines are read; along s it is one slice in step[2], the
// middle one. Means are good to 8 HU.
struct CoarseGrid {
  GridGeometry voxels;               // of the volume
  std::array<int, 3> axis{0, 1, 2};  // which of i, j, k runs along a, b, s
  Index3 step{1, 1, 1};
  Index3 size{0, 0, 0};
  Vec3 cell_mm{1.0};
  std::vector<std::int16_t> mean;   // HU, a fastest, then b, then s
  std::vector<std::uint8_t> marks;  // CellMark bits of the cell's voxels

  std::size_t count() const {
    return std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]);
  }
  std::size_t indexOf(int a, int b, int s) const {
    return (std::size_t(s) * std::size_t(size[1]) + std::size_t(b)) * std::size_t(size[0]) +
           std::size_t(a);
  }
  // The cell that a voxel lies in.
  std::size_t cellOf(const Index3& voxel) const {
    return indexOf(voxel[std::size_t(axis[0])] / step[0], voxel[std::size_t(axis[1])] / step[1],
                   voxel[std::size_t(axis[2])] / step[2]);
  }
  bool holds(int a, int b, int s) const {
    return a >= 0 && b >= 0 && s >= 0 && a < size[0] && b < size[1] && s < size[2];
  }
  // Whether a box of voxels holds some of cell (a, b, s).
  bool isIn(const VoxelBox& box, int a, int b, int s) const;
  // The middle of cell (a, b, s), LPS mm.
  Vec3 place_mm(double a, double b, double s) const;
  // The cell that a place lies in, which may be beyond the grid.
  Index3 cellAt(const Vec3& mm) const;
};

// What cells to aim at: larger ones where there would be more than `most` (3 bytes each).
struct CellSize {
  double across_mm = 3.0, along_mm = 5.0;
  std::size_t most = 1'000'000;
};

// Two threads.
CoarseGrid coarseGrid(const Volume& volume, const CellSize& cells = {});

}  // namespace trephine
