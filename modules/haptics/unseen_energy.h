// How much energy an arm may give out unseen: the tolerance of every energy account here.
#pragma once

#include <algorithm>

namespace trephine {

// Net energy [J] that the arm's encoder cannot see: 1 N over one of its steps [m].
constexpr double unseenEnergy_J(double encoder_step_m) {
  return std::max(5e-5, 1.0 * encoder_step_m);
}

}  // namespace trephine
