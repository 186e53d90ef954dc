// The solid that a tool sweeps, as rows of voxels: geometry only. All lengths in millimetres, in the
// grid's own axes: voxel (i, j, k) has its centre at (i sx, j sy, k sz).
#pragma once

#include <array>

#include "base/math.h"
#include "volume/volume.h"

namespace trephine {

// All within a radius of a segment.
struct Capsule {
  Vec3 from{0.0}, to{0.0};
  double radius = 0.0;
};

// From `low` to `high`; empty where low > high.
struct Interval {
  double low = 1.0, high = 0.0;
  bool empty() const { return !(low <= high); }
};

// Where the line along x through (y, z) lies within the capsule.
Interval rowWithin(const Capsule& capsule, double y, double z);

// Bounds of y for the part of the capsule that the plane z cuts; never too narrow.
Interval bandWithin(const Capsule& capsule, double z);

// What a capsule sweeps on its way between two places: it stands at up to kMost places between,
// close enough that what lies between them is within a 1/30 of the radius.
class SweptSolid {
 public:
  SweptSolid() = default;
  SweptSolid(const Capsule& from, const Capsule& to);

  Interval row(double y, double z) const;
  Interval band(double z) const;
  Interval depth() const;  // bounds of z
  int places() const { return count_; }

 private:
  static constexpr int kMost = 32;
  std::array<Capsule, kMost> places_{};
  int count_ = 0;
};

// How far the farther end moved.
double moved(const Capsule& from, const Capsule& to);

}  // namespace trephine
