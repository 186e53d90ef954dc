#include "haptics/arm_estimator.h"

#include <tuple>
#include <utility>

namespace trephine {

namespace {

// Tuned on the stability grid: hand forces that wander by 0.7 N in a second.
constexpr double kHandJerk_N_per_sqrt_s = 0.73;
constexpr double kFinestStep_m = 1e-8;  // below this a sample counts as exact
constexpr double kJump_m = 0.02;        // within a period, beyond what was expected
constexpr int kRiccatiSteps = 4000;

using Matrix = std::array<std::array<double, 3>, 3>;

// The gains, and the variance of a surprise.
std::pair<std::array<double, 3>, double> steadyState(double T, double variance, double jerk2) {
  const Matrix F{{{1.0, T, T * T / 2.0}, {0.0, 1.0, T}, {0.0, 0.0, 1.0}}};
  const double T2 = T * T, T3 = T2 * T;
  const Matrix Q{{{jerk2 * T3 * T2 / 20.0, jerk2 * T2 * T2 / 8.0, jerk2 * T3 / 6.0},
                  {jerk2 * T2 * T2 / 8.0, jerk2 * T3 / 3.0, jerk2 * T2 / 2.0},
                  {jerk2 * T3 / 6.0, jerk2 * T2 / 2.0, jerk2 * T}}};
  Matrix P{{{1e-6, 0.0, 0.0}, {0.0, 1e-2, 0.0}, {0.0, 0.0, 1e2}}};
  std::array<double, 3> gain{};
  double surprise = 0.0;
  for (int step = 0; step < kRiccatiSteps; ++step) {
    Matrix FP{}, S = Q;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        for (int l = 0; l < 3; ++l) FP[i][j] += F[i][l] * P[l][j];
      }
    }
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        for (int l = 0; l < 3; ++l) S[i][j] += FP[i][l] * F[j][l];
      }
    }
    surprise = S[0][0] + variance;
    for (int i = 0; i < 3; ++i) gain[i] = S[i][0] / surprise;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) P[i][j] = S[i][j] - gain[i] * S[0][j];
    }
  }
  return {gain, surprise};
}

}  // namespace

ArmEstimator::ArmEstimator(const ArmDynamics& arm, double period_s)
    : T_(period_s), mass_kg_(arm.apparent_mass_kg) {
  const double q = arm.encoder_step_m;
  const double jerk = kHandJerk_N_per_sqrt_s / mass_kg_;
  std::tie(gain_, surprise_variance_m2_) =
      steadyState(T_, q * q / 12.0 + kFinestStep_m * kFinestStep_m, jerk * jerk);
}

void ArmEstimator::restart(const Vec3& position_m) {
  started_ = true;
  x_ = position_m;
  v_ = a_ = surprise_m_ = Vec3(0.0);
}

void ArmEstimator::update(const Vec3& position_m, const Vec3& held_N, double lighter,
                          const Vec3& skew_N) {
  if (!started_) return restart(position_m);
  const Vec3 acceleration = held_N * (lighter / mass_kg_) + a_;
  x_ += T_ * v_ + (0.5 * T_ * T_) * (acceleration + skew_N * (lighter / mass_kg_));
  v_ += T_ * acceleration;
  surprise_m_ = position_m - x_;
  // No hand moves an arm so far in a period: the sample jumped.
  if (!(glm::length(surprise_m_) < kJump_m)) return restart(position_m);
  x_ += gain_[0] * surprise_m_;
  v_ += gain_[1] * surprise_m_;
  a_ += gain_[2] * surprise_m_;
}

}  // namespace trephine
