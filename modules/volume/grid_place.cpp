#include "volume/grid_place.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trephine {

double cornersApart_mm(const GridGeometry& a, const GridGeometry& b) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  if (a.size != b.size) return kFar;
  double most = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 at(corner & 1 ? a.size[0] - 1 : 0, corner & 2 ? a.size[1] - 1 : 0,
                  corner & 4 ? a.size[2] - 1 : 0);
    const double apart = glm::length(a.toPatient_mm(at) - b.toPatient_mm(at));
    if (!std::isfinite(apart)) return kFar;
    most = std::max(most, apart);
  }
  return most;
}

}  // namespace trephine
