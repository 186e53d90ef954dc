#include "haptics/controllers.h"

namespace trephine {

Vec3 SeedController::bound(const ControllerInput& in) {
  const Vec3 f = -in.demanded_N;
  const Vec3& v = in.velocity_m_s;
  const double T = in.period_s;
  observer_J += (glm::dot(f, v) + last_alpha * last_vp2) * T;

  const double f2 = glm::dot(f, f);
  const Vec3 v_p = f2 > 0.0 ? glm::dot(f, v) / f2 * f : Vec3(0.0);
  last_vp2 = glm::dot(v_p, v_p);
  last_alpha = observer_J < 0.0 && last_vp2 > 0.0 ? -observer_J / (T * last_vp2) : 0.0;
  return -(f + last_alpha * v_p);
}

std::string_view controllerName(ControllerKind kind) {
  for (const auto& [name, k] : kControllerNames) {
    if (k == kind) return name;
  }
  return "";
}

Controller makeController(ControllerKind kind, const ArmDynamics& arm, double period_s,
                          int touch_version) {
  switch (kind) {
    case ControllerKind::off: return OffController{};
    case ControllerKind::seed: return SeedController{};
    case ControllerKind::bounded: return BoundedController(arm, period_s, touch_version);
  }
  return OffController{};
}

}  // namespace trephine
