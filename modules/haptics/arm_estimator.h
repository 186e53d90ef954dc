// Where the arm is, how fast it moves and how hard the hand pushes it, from quantised samples and
// the forces that were sent. One steady-state Kalman filter for all three axes.
#pragma once

#include <array>

#include "haptics/arm_dynamics.h"

namespace trephine {

// State x [m], v [m/s], a [m/s2] = hand force over apparent mass, each a vector in device axes:
//   x' = v,  v' = F / m + a,  a' = white noise of kHandJerk / m (the hand changes its force slowly)
// seen through z = x + noise of variance q^2 / 12 (a quantiser of step q). The gains are those of
// the steady state (the Riccati equation, iterated in the constructor; Kalman 1960), so a tick is
// nine multiplications an axis.
class ArmEstimator {
 public:
  ArmEstimator(const ArmDynamics& arm, double period_s);

  // After a period in which `held_N` acted on the arm, the sample reads `position_m`. A sample 20
  // mm from the expected one starts the filter anew, at rest. `lighter`: stated mass / mass.
  // `skew_N`: what a force that changed within the period moves the arm further than its mean does,
  // as a force: share (1 - share) (first - second), `share` that of the first in the period.
  void update(const Vec3& position_m, const Vec3& held_N, double lighter = 1.0,
              const Vec3& skew_N = Vec3(0.0));
  void forget() { started_ = false; }

  const Vec3& position_m() const { return x_; }
  const Vec3& velocity_m_s() const { return v_; }
  const Vec3& handAcceleration_m_s2() const { return a_; }
  // The surprise: the last sample less the expected one; and its variance on an arm that is as
  // stated.
  const Vec3& surprise_m() const { return surprise_m_; }
  double surpriseVariance_m2() const { return surprise_variance_m2_; }
  // What a surprise adds to x, v and a.
  const std::array<double, 3>& gain() const { return gain_; }
  // Time constant with which the position follows the samples, less a period [s].
  double lag_s() const { return T_ / gain_[0] - T_; }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.x_, self.v_, self.a_, self.started_);
  }

 private:
  void restart(const Vec3& position_m);

  double T_;
  double mass_kg_;
  std::array<double, 3> gain_{};
  double surprise_variance_m2_ = 0.0;
  Vec3 x_{0.0}, v_{0.0}, a_{0.0}, surprise_m_{0.0};
  bool started_ = false;
};

}  // namespace trephine
