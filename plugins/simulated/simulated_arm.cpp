#include "simulated_arm.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace trephine::simulated {

namespace {

constexpr int kMinSubsteps = 20;
constexpr double kMaxSubstep_s = 50e-6;
// A host that clamps at the peak itself may miss it by a rounding error.
constexpr double kPeakTolerance = 1.0 + 1e-9;

int substeps(double dt_s) {
  int n = int(dt_s / kMaxSubstep_s);
  if (n * kMaxSubstep_s < dt_s) ++n;
  return std::max(n, kMinSubsteps);
}

// std::round is a library call; the steps are few enough for a 64-bit integer.
double nearestStep(double value, double step) {
  const double steps = value / step;
  return double(std::int64_t(steps < 0.0 ? steps - 0.5 : steps + 0.5)) * step;
}

// One axis goes on for `h` at the mean speed `u`, and stops at the workspace's edge.
void moveAxis(double u, double h, double edge, double& x, double& v, bool& at_limit) {
  x += h * u;
  v = 2.0 * u - v;
  if (x > edge || x < -edge) {
    x = x > edge ? edge : -edge;
    v = 0.0;
    at_limit = true;
  }
}

// One substep of all axes, which the friction's direction couples; advance() has the rule. What
// presses an axis against the edge of the workspace moves nothing and overcomes no friction.
void stepWithFriction(const ArmParameters& arm, const Hand& hand, const Vector& force, double h,
                      double inverse, ArmMotion& next) {
  Vector push{};
  double sum = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = next.position_m[axis];
    const double edge = 0.5 * arm.workspace_m[axis];
    double& p = push[axis];
    p = 2.0 * arm.mass_kg * next.velocity_m_s[axis] +
        h * (force[axis] + hand.stiffness_N_per_m * (hand.rest_m[axis] - x));
    if ((x >= edge && p > 0.0) || (x <= -edge && p < 0.0)) {
      p = 0.0;
      next.at_limit = true;
    }
    sum += p * p;
  }
  const double length = std::sqrt(sum);
  if (length <= h * arm.friction_N) {
    next.velocity_m_s = {};
    return;
  }
  const double left = (1.0 - h * arm.friction_N / length) * inverse;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double edge = 0.5 * arm.workspace_m[axis];
    double& x = next.position_m[axis];
    double& v = next.velocity_m_s[axis];
    if (push[axis] == 0.0) {
      v = 0.0;
      continue;
    }
    moveAxis(left * push[axis], h, edge, x, v, next.at_limit);
  }
}

}  // namespace

ArmMotion advance(const ArmParameters& arm, const Hand& hand, const ArmMotion& motion,
                  const Vector& force_N, double dt_s) {
  ArmMotion next = motion;
  next.at_limit = false;
  const Vector force = limitedForce(force_N, arm.peak_force_N);
  const int n = substeps(dt_s);
  const double h = dt_s / n;
  const double m = arm.mass_kg;
  const double k = hand.stiffness_N_per_m;
  const double damping = hand.damping_Ns_per_m + arm.damping_Ns_per_m;
  // With the mean speed u = (v + v')/2 the rule reads
  //   2 m (u - v) = h [f + k (x_h - x - u h/2) - (b + c) u],  x' = x + h u,  v' = 2 u - v.
  // and friction, along the mean speed too, shortens the right side, without u, by h F.
  const double inverse = 1.0 / (2.0 * m + h * damping + 0.5 * h * h * k);
  if (arm.friction_N > 0.0) {
    for (int i = 0; i < n; ++i) stepWithFriction(arm, hand, force, h, inverse, next);
    return next;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double edge = 0.5 * arm.workspace_m[axis];
    double x = motion.position_m[axis];
    double v = motion.velocity_m_s[axis];
    for (int i = 0; i < n; ++i) {
      const double pull = force[axis] + k * (hand.rest_m[axis] - x);
      moveAxis((2.0 * m * v + h * pull) * inverse, h, edge, x, v, next.at_limit);
    }
    next.position_m[axis] = x;
    next.velocity_m_s[axis] = v;
  }
  return next;
}

Vector encoderReading(const ArmParameters& arm, const Vector& position_m) {
  if (arm.encoder_step_m == 0.0) return position_m;
  Vector reading{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    reading[axis] = nearestStep(position_m[axis], arm.encoder_step_m);
  }
  return reading;
}

Vector insideWorkspace(const ArmParameters& arm, const Vector& position_m) {
  Vector inside{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double edge = 0.5 * arm.workspace_m[axis];
    inside[axis] = std::clamp(position_m[axis], -edge, edge);
  }
  return inside;
}

Vector limitedForce(const Vector& force_N, double peak_N) {
  double largest = 0.0;
  for (double f : force_N) largest = std::max(largest, f < 0.0 ? -f : f);
  if (largest == 0.0) return force_N;
  // Divided first, so that the squares of a huge force cannot overflow.
  Vector direction{};
  double sum = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    direction[axis] = force_N[axis] / largest;
    sum += direction[axis] * direction[axis];
  }
  const double length = std::sqrt(sum);  // of `direction`, between 1 and sqrt(3)
  if (length <= peak_N / largest * kPeakTolerance) return force_N;
  for (double& d : direction) d *= peak_N / length;
  return direction;
}

}  // namespace trephine::simulated
