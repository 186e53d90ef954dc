#include "ui/views/slice_measure.h"

#include <numbers>

namespace trephine {

double length_mm(const Measure& ruler) {
  return ruler.points_mm.size() < 2 ? 0.0 : glm::distance(ruler.points_mm[0], ruler.points_mm[1]);
}

double angle_deg(const Measure& angle) {
  if (angle.points_mm.size() < 3) return 0.0;
  const Vec3 a = angle.points_mm[0] - angle.points_mm[1];
  const Vec3 b = angle.points_mm[2] - angle.points_mm[1];
  // Precise for small angles too, where the cosine is not.
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180.0 / std::numbers::pi;
}

}  // namespace trephine
