#include "haptics/laws/viscous.h"

namespace trephine {

void ViscousLaw::add(const LawInput& in, ContactForce& out) const {
  for (const TouchPoint& p : in.points) {
    if (p.tissue_class < 0) continue;
    const double b = in.share.damping * p.weight * in.tissue(p).damping_Ns_per_m;
    out.damping += b;
    out.damped_turning_N += b * p.turning_m_s;
    out.torque_Nm -= glm::cross(p.arm_m, b * (in.velocity_m_s + p.turning_m_s));
  }
}

}  // namespace trephine
