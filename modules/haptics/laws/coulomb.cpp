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
      spring.stiffness = 0.0;
      continue;
    }
    const Vec3 at_m = in.tip_m + p.lever_m;
    const double before = spring.stiffness;
    if (before == 0.0) spring.anchor_m = spring.at_m = at_m;
    spring.stiffness = k;
    if (in.pull.drags && in.tissue(p).solid) goBack(in, p, spring, at_m);
    spring.at_m = at_m;
    Vec3 stretch_m = at_m - spring.anchor_m;
    if (before > 0.0 && k > before) {
      stretch_m *= before / k;
      spring.anchor_m = at_m - stretch_m;
    }
    const double length_m = glm::length(stretch_m);
    const double limit_m = in.tissue(p).friction_N / k;
    if (length_m > limit_m) {
      stretch_m *= limit_m / length_m;
      spring.anchor_m = at_m - stretch_m;
    }
    const Vec3 force_N = -(p.weight * k) * stretch_m;
    out.elastic_N += force_N;
    out.stiffness += p.weight * k;
    out.stored_J += 0.5 * p.weight * k * glm::dot(stretch_m, stretch_m);
    out.addElasticTorque(glm::cross(p.lever_m, force_N));
  }
}

// The anchor goes along with the tool; the stretch goes back as far as the arm moves against it.
void CoulombLaw::goBack(const LawInput& in, const TouchPoint& p, Spring& spring,
                        const Vec3& at_m) const {
  Vec3 stretch_m = spring.at_m - spring.anchor_m;
  const double length_m = glm::length(stretch_m);
  if (length_m > 0.0) {
    const Vec3 arm_m = in.period_s * (in.velocity_m_s + p.rotational_m_s);
    const double back_m = -glm::dot(arm_m, stretch_m) / length_m;
    stretch_m *= 1.0 - std::clamp(back_m / length_m, 0.0, 1.0);
  }
  spring.anchor_m = at_m - stretch_m;
}

}  // namespace trephine
