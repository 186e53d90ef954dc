#include "haptics/laws.h"

namespace trephine {

void ViscousLaw::add(const LawInput& in, ContactForce& out) const {
  if (in.contact.touching()) out.damping += in.tissue.damping_Ns_per_m;
}

void ElasticLaw::add(const LawInput& in, ContactForce& out) {
  const double k = in.tissue.stiffness_N_per_m;
  if (!in.contact.touching() || k <= 0.0) {
    anchor_m.reset();
    return;
  }
  if (!anchor_m) anchor_m = in.tip_m;
  Vec3 stretch_m = in.tip_m - *anchor_m;
  const double length_m = glm::length(stretch_m);
  const double limit_m = in.tissue.yield_N / k;
  if (length_m > limit_m) {
    stretch_m *= limit_m / length_m;
    anchor_m = in.tip_m - stretch_m;
  }
  out.elastic_N -= k * stretch_m;
  out.stiffness += k;
}

Law makeLaw(LawKind kind) {
  if (kind == LawKind::elastic) return ElasticLaw{};
  return ViscousLaw{};
}

}  // namespace trephine
