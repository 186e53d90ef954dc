// The grid that structures are grown on: blocks of voxels of about 3 mm, each the mean of its HU.
// An organ is told from its neighbours over millimetres, not over voxels: coarser voxels have less
// noise, and what is done on them takes as long for any resolution of the CT.
#pragma once

#include <cstdint>
#include <vector>

#include "base/progress.h"
#include "volume/volume.h"

namespace trephine {

// Blocks [low, high) of `factor` voxels each way; at the far faces of what there is. A plain value.
struct WorkGrid {
  Index3 factor{1, 1, 1};
  Index3 size{0, 0, 0};
  Vec3 block_mm{1.0};

  std::size_t count() const {
    return std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]);
  }
  std::size_t indexOf(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(size[1]) + std::size_t(j)) * std::size_t(size[0]) +
           std::size_t(i);
  }
  bool holds(int i, int j, int k) const {
    return i >= 0 && j >= 0 && k >= 0 && i < size[0] && j < size[1] && k < size[2];
  }
  Index3 blockOf(const Index3& voxel) const {
    return {voxel[0] / factor[0], voxel[1] / factor[1], voxel[2] / factor[2]};
  }
};

struct HuSpan {
  double low = 0.0, high = 0.0;
  friend bool operator==(const HuSpan&, const HuSpan&) = default;
};

using Blocks = std::vector<float>;            // a HU each
using BlockMask = std::vector<std::uint8_t>;  // 0 or 1 each

constexpr double kBlock_mm = 3.0;
WorkGrid workGridOf(const GridGeometry& geometry, double block_mm = kBlock_mm);
// Two threads.
Blocks blockMeans(const Volume& volume, const WorkGrid& grid);

// Smoothed by a Gaussian of so many mm (standard deviation), by VTK.
Blocks smoothed(const Blocks& blocks, const WorkGrid& grid, double sigma_mm);

// Standard deviation of the noise in soft tissue, HU: robust, of second differences along i, which
// neither slopes nor edges between organs raise. 0 where there is no soft tissue.
double softTissueNoise_HU(const Blocks& blocks, const WorkGrid& grid);

// Blocks whose HU lie in [low, high].
BlockMask within(const Blocks& blocks, double low, double high);
// Distance of each block to the nearest one that is in, mm; infinity where none is. Exact, between
// middles (Felzenszwalb & Huttenlocher 2012, lower envelopes of parabolas). VTK's own takes four
// times as long (1.6 million blocks: 124 ms against 28), and growing takes a dozen. Two threads.
std::vector<float> distance_mm(const BlockMask& in, const WorkGrid& grid);
// What is farther than `radius_mm` from all that is out; the grid's border is no end.
BlockMask eroded(const BlockMask& in, const WorkGrid& grid, double radius_mm);
BlockMask dilated(const BlockMask& in, const WorkGrid& grid, double radius_mm);

// The number of each block's piece, from 1 on, 0 of what is out: blocks that share a face. By VTK.
std::vector<std::int32_t> pieces(const BlockMask& in, const WorkGrid& grid);
// What no way of blocks outside leads to from the grid's border becomes part of it.
void fillHoles(BlockMask& in, const WorkGrid& grid);
// Each block as most of the 19 are: itself, those across a face and across an edge.
BlockMask majority(const BlockMask& in, const WorkGrid& grid);

}  // namespace trephine
