// A ruler or an angle on a slice. Its points lie in the patient, so that what it says is true for
// any grid: oblique, tilted, of any voxels. Pure.
#pragma once

#include <vector>

#include "base/math.h"

namespace trephine {

struct Measure {
  enum class Kind { ruler, angle } kind = Kind::ruler;
  std::vector<Vec3> points_mm;  // the two ends; or an end, the corner, the other end

  std::size_t wanted() const { return kind == Kind::ruler ? 2 : 3; }
  bool complete() const { return points_mm.size() == wanted(); }
};

double length_mm(const Measure& ruler);
// In [0, 180]; 0 where an arm has no length.
double angle_deg(const Measure& angle);

}  // namespace trephine
