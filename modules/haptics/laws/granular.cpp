#include "haptics/laws/granular.h"

#include <algorithm>
#include <cmath>

namespace trephine {

void GranularLaw::engage() {
  for (Point& point : of_points) point.stiffness = 0.0;
}

void GranularLaw::add(const LawInput& in, ContactForce& out) {
  constexpr Grains kGrains;
  for (std::size_t i = 0; i < in.points.size(); ++i) {
    const TouchPoint& p = in.points[i];
    Point& point = of_points[i];
    const Impedance demanded = p.tissue_class >= 0 ? impedance(in.tissue(p)) : Impedance{};
    const double k = in.share.stiffness * demanded.stiffness;
    if (!(k > 0.0)) {
      point.packed *= kGrains.resting;
      point.stiffness = 0.0;
      continue;
    }
    const Vec3 at_m = in.tip_m + p.lever_m;
    if (point.stiffness == 0.0) point.anchor_m = at_m;
    Vec3 stretch_m = at_m - point.anchor_m;
    if (point.stiffness > 0.0 && k > point.stiffness) stretch_m *= point.stiffness / k;
    point.stiffness = k;
    const double share = kGrains.loose_yield +
                         (kGrains.packed_yield - kGrains.loose_yield) * point.packed;
    const double limit_m = share * in.tissue(p).friction_N / k;
    const double length_m = glm::length(stretch_m);
    if (length_m > limit_m) {
      const Vec3 way = stretch_m / length_m;
      const double dragged_m = length_m - limit_m;
      const double along = glm::dot(way, point.ahead);
      const double over_m = along < 0.0 ? kGrains.loosening_m : kGrains.packing_m;
      const double towards = along < 0.0 ? 0.0 : 1.0;
      point.packed += (towards - point.packed) * std::min(1.0, dragged_m / over_m);
      if (along >= 0.0 || point.packed < kGrains.resting) point.ahead = way;
      stretch_m = way * limit_m;
    }
    point.anchor_m = at_m - stretch_m;
    const Vec3 force_N = -(p.weight * k) * stretch_m;
    out.elastic_N += force_N;
    out.stiffness += p.weight * k;
    out.stored_J += 0.5 * p.weight * k * glm::dot(stretch_m, stretch_m);
    out.addElasticTorque(glm::cross(p.lever_m, force_N));
    const double b = in.share.damping * p.weight * demanded.damping;
    out.damping += b;
    out.damped_rotation_N += b * p.rotational_m_s;
    out.torque_Nm -= glm::cross(p.lever_m, b * (in.velocity_m_s + p.rotational_m_s));
  }
}

}  // namespace trephine
