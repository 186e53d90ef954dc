#include "haptics/laws/coulomb.h"

#include <algorithm>

namespace trephine {

void CoulombLaw::add(const LawInput& in, ContactForce& out) {
  for (std::size_t i = 0; i < in.points.size(); ++i) {
    const TouchPoint& p = in.points[i];
    Spring& spring = springs[i];
    const double k =
        p.tissue_class >= 0 ? in.share.stiffness * impedance(in.tissue(p)).stiffness : 0.0;
    if (!(k > 0.0)) {
      spring = {};
      continue;
    }
    const Vec3 at_m = in.tip_m + p.lever_m;
    if (spring.stiffness == 0.0) spring.at_m = at_m;
    if (spring.stiffness > 0.0 && k > spring.stiffness) spring.stretch_m *= spring.stiffness / k;
    spring.stiffness = k;
    const Vec3 moved_m = at_m - spring.at_m;
    spring.at_m = at_m;
    const double before_m = glm::length(spring.stretch_m);
    if (!in.pull.drags || !in.tissue(p).solid) {
      spring.stretch_m += moved_m;
    } else if (before_m > 0.0) {  // it goes as far as the arm takes it back
      const Vec3 arm_m = in.period_s * (in.velocity_m_s + p.rotational_m_s);
      const double back_m = -glm::dot(arm_m, spring.stretch_m) / before_m;
      spring.stretch_m *= 1.0 - std::clamp(back_m / before_m, 0.0, 1.0);
    }
    const double length_m = glm::length(spring.stretch_m);
    const double limit_m = in.tissue(p).friction_N / k;
    if (length_m > limit_m) spring.stretch_m *= limit_m / length_m;
    const Vec3 force_N = -(p.weight * k) * spring.stretch_m;
    out.elastic_N += force_N;
    out.stiffness += p.weight * k;
    out.stored_J += 0.5 * p.weight * k * glm::dot(spring.stretch_m, spring.stretch_m);
    out.addElasticTorque(glm::cross(p.lever_m, force_N));
  }
}

}  // namespace trephine
