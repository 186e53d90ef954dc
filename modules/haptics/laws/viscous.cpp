#include "haptics/laws/viscous.h"

namespace trephine {

void ViscousLaw::add(const LawInput& in, ContactForce& out) const {
  for (const TouchPoint& p : in.points) {
    if (p.tissue_class < 0) continue;
    const double b = in.share.damping * p.weight * impedance(in.tissue(p)).damping;
    out.damping += b;
    out.damped_rotation_N += b * p.rotational_m_s;
    out.torque_Nm -= glm::cross(p.lever_m, b * (in.velocity_m_s + p.rotational_m_s));
  }
}

}  // namespace trephine
