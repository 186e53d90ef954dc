#include "haptics/laws/coulomb.h"

namespace trephine {

void CoulombLaw::add(const LawInput& in, ContactForce& out) {
  for (std::size_t i = 0; i < in.points.size(); ++i) {
    const TouchPoint& p = in.points[i];
    const double k =
        p.tissue_class >= 0 ? in.share.stiffness * impedance(in.tissue(p)).stiffness : 0.0;
    if (!(k > 0.0)) {
      stiffness[i] = 0.0;
      continue;
    }
    const Vec3 at_m = in.tip_m + p.lever_m;
    const double before = stiffness[i];
    if (before == 0.0) anchors_m[i] = at_m;
    stiffness[i] = k;
    Vec3 stretch_m = at_m - anchors_m[i];
    if (before > 0.0 && k > before) {
      stretch_m *= before / k;
      anchors_m[i] = at_m - stretch_m;
    }
    const double length_m = glm::length(stretch_m);
    const double limit_m = in.tissue(p).friction_N / k;
    if (length_m > limit_m) {
      stretch_m *= limit_m / length_m;
      anchors_m[i] = at_m - stretch_m;
    }
    const Vec3 force_N = -(p.weight * k) * stretch_m;
    out.elastic_N += force_N;
    out.stiffness += p.weight * k;
    out.stored_J += 0.5 * p.weight * k * glm::dot(stretch_m, stretch_m);
    out.addElasticTorque(glm::cross(p.lever_m, force_N));
  }
}

}  // namespace trephine
