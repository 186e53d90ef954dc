// Labels as the ray caster samples them, two bytes a voxel: their borders are smooth surfaces
// between voxel centres instead of the voxels' steps, and exact at the centres. Pure.
#pragma once

#include <cstdint>
#include <vector>

#include "volume/label_map.h"

namespace trephine {

// Its label, or without one that of a neighbour which has one (the highest); and how much of the 27
// voxels around it has a label, in 255ths, nearer ones weighing more (1 2 1): over a half for a
// voxel with a label, else less. It knows no tissues, so that it stays when those change.
struct LabelShape {
  std::uint8_t label;
  std::uint8_t inside;
};

// Of a box of voxels, slice by slice, from below.
class LabelShapes {
 public:
  // The map outlives this.
  LabelShapes(const LabelMap& labels, const VoxelBox& box);
  // The slice of the grid that next() is of.
  int slice() const { return k_; }
  bool done() const { return k_ >= box_.high[2]; }
  // Of the next slice, as wide and high as the box; valid until the next call.
  const std::vector<LabelShape>& next();

 private:
  // Of a slice: sums over 3 x 3, at most 16, and the highest label there. Empty: all are 0.
  struct Plane {
    std::vector<std::uint8_t> folded, highest;
    bool any = false;
  };
  void addSlice(int k);

  const LabelMap& labels_;
  VoxelBox box_;
  int k_;
  std::size_t width_, height_;
  std::vector<std::uint8_t> marks_;          // labels of a slice of the box and one voxel around it
  std::vector<std::uint8_t> across_, most_;  // of its rows: sums over 3, and the highest
  Plane planes_[3];                          // of slices k-1, k, k+1
  std::vector<LabelShape> shapes_;
};

}  // namespace trephine
