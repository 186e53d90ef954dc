// Controllers: what may change the demanded force to keep the arm passive. All at the device, in
// device metres. Forces here are those on the arm; the paper's port force is their opposite.
//
//   Impedance limit(const Impedance&)    what the laws shall render of a tissue, at the device
//   Vec3 bound(const ControllerInput&)   the force on the arm [N]
//   void forget()                        after an undo, a reset or a fault: no credit
//   ControllerReport report()            what it observed and did in this tick, for the record
//
// To add a controller: README.md.
#pragma once

#include <array>
#include <string_view>
#include <utility>
#include <variant>

#include "base/math.h"
#include "haptics/bounded_controller.h"

namespace trephine {

struct OffController {
  Impedance limit(const Impedance& tissue) { return tissue; }
  Vec3 bound(const ControllerInput& in) { return in.demanded_N; }
  void forget() {}
  ControllerReport report() const { return {}; }
};

// Seed paper, eqs. 7-12 verbatim. Our reading of the 3-D case, since the paper gives 7-9 for one
// axis and 10-12 for three:
//   port force f = -demanded; observer sums over the axes (eq. 10):
//     E(n) = E(n-1) + [f . v + alpha(n-1) |v_p(n-1)|^2] T        (7, with v_p for v)
//   v_p = (f . v / |f|^2) f                                      (11)
//   alpha = -E / (T |v_p|^2) if E < 0 and |v_p| > 0, else 0      (8)
//   output f + alpha v_p                                         (9, 12)
// While f is zero there is no direction to project on: v_p = 0, and no compensation.
// Known limits (CONTROLLERS.md): its observer does not see the energy that sampling a damper makes,
// and alpha grows without bound near rest. It is here to be compared with.
struct SeedController {
  Impedance limit(const Impedance& tissue) { return tissue; }
  Vec3 bound(const ControllerInput& in);
  void forget() { *this = SeedController{}; }
  ControllerReport report() const {
    return {.observer_J = observer_J,
            .alpha = last_alpha,
            .parts = last_alpha > 0.0 ? std::uint32_t(kPartDamping) : 0u};
  }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.observer_J, self.last_alpha, self.last_vp2);
  }

  double observer_J = 0.0;  // E
  double last_alpha = 0.0;
  double last_vp2 = 0.0;  // |v_p|^2
};

using Controller = std::variant<OffController, SeedController, BoundedController>;

enum class ControllerKind : std::int32_t { off, seed, bounded };
inline constexpr std::array<std::pair<std::string_view, ControllerKind>, 3> kControllerNames{
    {{"off", ControllerKind::off},
     {"seed", ControllerKind::seed},
     {"bounded", ControllerKind::bounded}}};
std::string_view controllerName(ControllerKind kind);

// Solves a small matrix equation for `bounded`: not for the tick.
Controller makeController(ControllerKind kind, const ArmDynamics& arm, double period_s,
                          int touch_version = kTouchVersion);

// The impedance that the laws shall render of a tissue with this one; before bound().
inline Impedance limitImpedance(Controller& controller, const Impedance& tissue) {
  return std::visit([&](auto& c) { return c.limit(tissue); }, controller);
}
inline Vec3 boundForce(Controller& controller, const ControllerInput& in) {
  return std::visit([&](auto& c) { return c.bound(in); }, controller);
}
inline ControllerReport reportOf(const Controller& controller) {
  return std::visit([](const auto& c) { return c.report(); }, controller);
}
inline void forgetController(Controller& controller) {
  std::visit([](auto& c) { c.forget(); }, controller);
}

}  // namespace trephine
