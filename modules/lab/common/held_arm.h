// The plant of the laboratory: an arm along one axis, held by a hand, moved exactly.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "haptics/arm_dynamics.h"

namespace trephine {

// x' = v, v' = (F - k_h (x - x_r) - (c + b_h) v) / m with F constant and x_r linear over each step:
// the state [x v F x_r x_r'] after a time h is exp(M h) times the state before.
class HeldArm {
 public:
  HeldArm(double mass_kg, double damping_Ns_per_m, const Impedance& hand, double step_s);

  // Moves x and v on by a step under `force`; the hand's rest point is at `rest` as it begins.
  void step(double& x, double& v, double force, double rest, double rest_speed) const {
    const std::array<double, 5> state{x, v, force, rest, rest_speed};
    x = v = 0.0;
    for (std::size_t i = 0; i < 5; ++i) {
      x += position_[i] * state[i];
      v += velocity_[i] * state[i];
    }
  }

 private:
  std::array<double, 5> position_{}, velocity_{};
};

// What is left of x without its centred mean over 2 `half` + 1 samples, narrower at the ends.
std::vector<double> lessItsMean(const std::vector<double>& x, std::size_t half);

}  // namespace trephine
