// A simulated arm in a hand, for the knob that needs one: the rate.
#pragma once

#include <cmath>

#include "base/math.h"

namespace trephine {

// m x'' = F + k (x_r - x) - (b + c) x' on each axis, F and the hand's rest point x_r held over a
// step; integrated by the implicit midpoint rule. Metres, newtons, seconds.
struct ArmInHand {
  double mass_kg = 0.045;
  double damping_Ns_per_m = 0.05;
  double encoder_m = 5.5e-5;
  double hand_stiffness = 300.0;  // N/m
  double hand_damping = 2.0;      // N s/m
  Vec3 position_m{0.0};
  Vec3 velocity_m_s{0.0};

  void step(const Vec3& force_N, const Vec3& rest_m, double h_s) {
    const double half = 0.5 * h_s / mass_kg;
    const Vec3 pull_N = force_N + hand_stiffness * (rest_m - position_m);
    const Vec3 middle =
        (velocity_m_s + half * pull_N) /
        (1.0 + half * (hand_damping + damping_Ns_per_m + 0.5 * h_s * hand_stiffness));
    position_m += h_s * middle;
    velocity_m_s = 2.0 * middle - velocity_m_s;
  }
  Vec3 reading_m() const {
    return encoder_m > 0.0 ? glm::round(position_m / encoder_m) * encoder_m : position_m;
  }
};

}  // namespace trephine
