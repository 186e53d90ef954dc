// The solid that a tool sweeps, as rows of voxels: geometry only. All lengths in millimetres, in the
// grid's own axes: voxel (i, j, k) has its centre at (i sx, j sy, k sz).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/math.h"

namespace trephine {

// What cuts is taken for at least so thick, half of it, in voxels along each axis, so that it takes
// a voxel wherever it is. 0.005 more than half for rounding.
inline constexpr double kHalfVoxel = 0.505;

// All within a radius of a segment.
struct Capsule {
  Vec3 from{0.0}, to{0.0};
  double radius = 0.0;
  bool isSphere() const { return from == to; }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.from, self.to, self.radius);
  }
};

// From `low` to `high`; empty where low > high.
struct Interval {
  double low = 1.0, high = 0.0;
  bool empty() const { return !(low <= high); }
};

inline Interval joined(const Interval& a, const Interval& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

// A capsule made ready to be asked for rows: many thousand times a tick.
class CapsuleRows {
 public:
  CapsuleRows() = default;
  explicit CapsuleRows(const Capsule& capsule);

  // Where the line along x through (y, z) lies within the capsule.
  Interval row(double y, double z) const {
    const Interval from = sphereRow(capsule_.from, y, z);
    return sphere_ ? from : joined(joined(from, sphereRow(capsule_.to, y, z)), sideRow(y, z));
  }
  // Bounds of y for the part of the capsule that the plane z cuts; never too narrow.
  Interval band(double z) const;
  const Capsule& capsule() const { return capsule_; }
  bool isSphere() const { return sphere_; }

 private:
  Interval sphereRow(const Vec3& centre, double y, double z) const {
    const double dy = y - centre.y, dz = z - centre.z;
    const double half2 = radius2_ - dy * dy - dz * dz;
    if (!(half2 >= 0.0)) return {};
    const double half = std::sqrt(half2);
    return {centre.x - half, centre.x + half};
  }
  Interval sideRow(double y, double z) const;

  Capsule capsule_;
  bool sphere_ = true;
  double radius2_ = -1.0;  // below 0: no radius holds nothing, not even its axis
  // The axis, its length, and what the quadratic of the side needs of it.
  Vec3 axis_{0.0};
  double length_ = 0.0, across2_ = 0.0, per_across2_ = 0.0, per_axis_x_ = 0.0;
};

// What a capsule sweeps on its way between two places, as the union of up to kMost capsules along
// it, so near to each other that the union falls short of the sweep by at most 1/30 of the radius.
// The first place itself is not part of it.
class SweptSolid {
 public:
  SweptSolid() = default;
  void set(const Capsule& from, const Capsule& to);

  Interval row(double y, double z) const {
    Interval out = places_[0].row(y, z);
    for (int n = 1; n < count_; ++n) out = joined(out, places_[std::size_t(n)].row(y, z));
    return out;
  }
  Interval band(double z) const;
  Interval width() const { return extent(0); }  // bounds of x
  Interval depth() const { return extent(2); }  // bounds of z
  int places() const { return count_; }

 private:
  Interval extent(int axis) const;
  static constexpr int kMost = 32;
  std::array<CapsuleRows, kMost> places_{};
  int count_ = 1;
};

// How far the farther end moved.
double moved(const Capsule& from, const Capsule& to);

}  // namespace trephine
