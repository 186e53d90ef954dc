#include "haptics/laws.h"

namespace trephine {

Vec3 ViscousLaw::force(const LawInput& in) const {
  if (!in.contact.touching()) return Vec3(0.0);
  return -in.tissue.damping_Ns_per_m * in.velocity_m_s;
}

Vec3 ElasticLaw::force(const LawInput& in) {
  const double k = in.tissue.stiffness_N_per_m;
  if (!in.contact.touching() || k <= 0.0) {
    anchor_m.reset();
    return Vec3(0.0);
  }
  if (!anchor_m) anchor_m = in.tip_m;
  Vec3 stretch_m = in.tip_m - *anchor_m;
  const double length_m = glm::length(stretch_m);
  const double limit_m = in.tissue.yield_N / k;
  if (length_m > limit_m) {
    stretch_m *= limit_m / length_m;
    anchor_m = in.tip_m - stretch_m;
  }
  return -k * stretch_m;
}

Law makeLaw(LawKind kind) {
  if (kind == LawKind::elastic) return ElasticLaw{};
  return ViscousLaw{};
}

}  // namespace trephine
