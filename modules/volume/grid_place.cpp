#include "volume/grid_place.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trephine {

std::array<Vec3, 8> cornerVoxels(const GridGeometry& grid) {
  std::array<Vec3, 8> corners;
  for (int corner = 0; corner < 8; ++corner) {
    corners[std::size_t(corner)] =
        Vec3(corner & 1 ? grid.size[0] - 1 : 0, corner & 2 ? grid.size[1] - 1 : 0,
             corner & 4 ? grid.size[2] - 1 : 0);
  }
  return corners;
}

double cornersApart_mm(const GridGeometry& a, const GridGeometry& b) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  if (a.size != b.size) return kFar;
  double most = 0.0;
  for (const Vec3& at : cornerVoxels(a)) {
    const double apart = glm::length(a.toPatient_mm(at) - b.toPatient_mm(at));
    if (!std::isfinite(apart)) return kFar;
    most = std::max(most, apart);
  }
  return most;
}

double cornersFrom_mm(const GridGeometry& of, const GridGeometry& other) {
  Index3 sizes = of.size, other_sizes = other.size;
  std::ranges::sort(sizes);
  std::ranges::sort(other_sizes);
  if (sizes != other_sizes) return std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (const Vec3& one : cornerVoxels(of)) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& theirs : cornerVoxels(other)) {
      least = std::min(least, glm::length(of.toPatient_mm(one) - other.toPatient_mm(theirs)));
    }
    most = std::max(most, least);
  }
  return most;
}

}  // namespace trephine
