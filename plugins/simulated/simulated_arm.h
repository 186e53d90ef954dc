// The physics of one simulated arm in a hand. Pure: no clock, no device, no allocation.
//
// A point mass m at x [m], with the arm's own damping c and dry friction F, the hand's spring k and
// damper b that pull it to rest at the hand's pose x_h, and the commanded force f held over the
// step:
//     m x'' = f + k (x_h - x) - (b + c) x' - F x'/|x'|
// At rest the friction takes whatever pulls, up to F. Without it the three axes are independent.
// The hand's damper works against the arm's speed, not against the
// speed relative to x_h: x_h is a rest pose that jumps from tick to tick and has no speed.
#pragma once

#include <array>

namespace trephine::simulated {

using Vector = std::array<double, 3>;

struct ArmParameters {
  double mass_kg = 0.0;
  double damping_Ns_per_m = 0.0;  // c
  double encoder_step_m = 0.0;    // 0: reads exactly
  Vector workspace_m{};           // full extent around the origin
  double peak_force_N = 0.0;      // of the force's length
  double friction_N = 0.0;        // F
};

// A light hand at the workspace's centre.
struct Hand {
  Vector rest_m{};
  double stiffness_N_per_m = 300.0;
  double damping_Ns_per_m = 2.0;
};

struct ArmMotion {
  Vector position_m{};
  Vector velocity_m_s{};
  bool at_limit = false;  // touched the workspace's edge during the last step
};

// The motion after `dt_s` > 0 under a finite force. Integrated in substeps of at most dt/20 and 50
// us by the implicit midpoint rule: second order, stable for any k and b, and without energy of its
// own (for b = c = F = f = 0 it keeps kinetic plus spring energy to rounding). An axis that reaches
// the edge of the workspace stops there.
ArmMotion advance(const ArmParameters& arm, const Hand& hand, const ArmMotion& motion,
                  const Vector& force_N, double dt_s);

// What the encoders read: the nearest whole step on each axis, half a step away from zero. At the
// workspace's edge this may lie half a step outside.
Vector encoderReading(const ArmParameters& arm, const Vector& position_m);

// `position_m` moved into the workspace.
Vector insideWorkspace(const ArmParameters& arm, const Vector& position_m);

// `force_N` shortened to `peak_N` where it is longer, its direction kept.
Vector limitedForce(const Vector& force_N, double peak_N);

}  // namespace trephine::simulated
