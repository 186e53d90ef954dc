// Labels as the ray caster samples them, two bytes a voxel: their borders are smooth surfaces
// between voxel centres instead of the voxels' steps, and exact at the centres. Pure.
#pragma once

#include <cstdint>
#include <vector>

#include "tissue/tissue_set.h"
#include "volume/label_map.h"

namespace trephine {

// The row of its label, or without one that of a neighbour which has one; and how much of the 27
// voxels around it has a label, in 255ths, nearer ones weighing more (1 2 1): over a half for a
// voxel with a label, else less. "A label" is one that has a row of its own.
struct LabelShape {
  std::uint8_t row;
  std::uint8_t inside;
};

// Slice by slice, from below.
class LabelShapes {
 public:
  // The map outlives this.
  LabelShapes(const LabelMap& labels, const LabelRows& rows);
  // Of the next slice, as many as it has voxels; valid until the next call.
  const std::vector<LabelShape>& next();

 private:
  void addSlice(int k);

  const LabelMap& labels_;
  const LabelRows& rows_;
  int k_ = 0;
  std::vector<std::uint8_t> marks_;         // rows of a slice
  std::vector<std::uint8_t> folded_[3];     // of slices k-1, k, k+1: sums over 3 x 3, at most 16
  std::vector<std::uint8_t> neighbour_[3];  // the largest row of 3 x 3
  std::vector<LabelShape> shapes_;
};

}  // namespace trephine
