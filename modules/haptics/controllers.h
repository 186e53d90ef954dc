// Controllers: what may change the demanded force to keep the arm passive. All at the device, in
// device metres. Forces here are those on the arm; the paper's port force is their opposite.
//
// To add a controller: a type here, its line in kControllerNames and makeController, its tests.
#pragma once

#include <array>
#include <string_view>
#include <utility>
#include <variant>

#include "base/math.h"

namespace trephine {

struct ControllerInput {
  Vec3 demanded_N{0.0};    // on the arm
  Vec3 velocity_m_s{0.0};  // of the arm
  double period_s = 0.001;
};

struct OffController {
  Vec3 bound(const ControllerInput& in) { return in.demanded_N; }
  void forget() {}
  double energy_J() const { return 0.0; }
  double alpha() const { return 0.0; }
};

// Seed paper, eqs. 7-12 verbatim. Our reading of the 3-D case, since the paper gives 7-9 for one
// axis and 10-12 for three:
//   port force f = -demanded; observer sums over the axes (eq. 10):
//     E(n) = E(n-1) + [f . v + alpha(n-1) |v_p(n-1)|^2] T        (7, with v_p for v)
//   v_p = (f . v / |f|^2) f                                      (11)
//   alpha = -E / (T |v_p|^2) if E < 0 and |v_p| > 0, else 0      (8)
//   output f + alpha v_p                                         (9, 12)
// While f is zero there is no direction to project on: v_p = 0, and no compensation.
// Known limits, measured in the design notes: blind to the energy that sampling a damper makes, and
// alpha grows without bound near rest. It is here to be compared with.
struct SeedController {
  Vec3 bound(const ControllerInput& in);
  void forget() { *this = SeedController{}; }
  double energy_J() const { return observer_J; }
  double alpha() const { return last_alpha; }

  double observer_J = 0.0;
  double last_alpha = 0.0;
  double last_vp2 = 0.0;
};

using Controller = std::variant<OffController, SeedController>;

enum class ControllerKind : std::int32_t { off, seed };
inline constexpr std::array<std::pair<std::string_view, ControllerKind>, 2> kControllerNames{
    {{"off", ControllerKind::off}, {"seed", ControllerKind::seed}}};
std::string_view controllerName(ControllerKind kind);

Controller makeController(ControllerKind kind);

}  // namespace trephine
