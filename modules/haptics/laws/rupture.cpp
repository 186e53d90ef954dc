#include "haptics/laws/rupture.h"

namespace trephine {

void RuptureLaw::add(const LawInput& in, ContactForce& out) {
  const auto whole = [this](std::int32_t c) { return !(ruptured >> c & 1u); };
  if (!in.touching()) {  // also where another tool has removed the tissue that was pressed in
    forget();
    return;
  }
  if (stretched < 0) {
    const std::int32_t c = in.tip_class;
    if (c < 0 || !whole(c) || !(in.tissues->classes[std::size_t(c)].rupture_N > 0.0)) return;
    const double speed = glm::length(in.velocity_m_s);
    stretched = c;
    entry_m = in.tip_m;
    inwards = speed > 0.0 ? in.velocity_m_s / speed : in.tool_direction;
  }
  const TissueClass& tissue = in.tissues->classes[std::size_t(stretched)];
  const Vec3 stretch_m = in.tip_m - entry_m;
  if (glm::dot(stretch_m, inwards) < 0.0) {
    stretched = -1;
    return;
  }
  // By the tissue's own stiffness, not the rendered one: when it ruptures must not depend on the
  // arm.
  if (glm::length(stretch_m) * tissue.stiffness_N_per_m >= tissue.rupture_N) {
    ruptured |= 1u << stretched;
    stretched = -1;
    return;
  }
  const double k = in.share.stiffness * tissue.stiffness_N_per_m;
  out.elastic_N -= k * stretch_m;
  out.stiffness += k;
  out.stored_J += 0.5 * k * glm::dot(stretch_m, stretch_m);
}

}  // namespace trephine
