#include "kinematics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trephine::woodenhaptics {

namespace {
constexpr double kPi = std::numbers::pi;
double perCount(std::size_t joint) {
  return 2.0 * kPi / kCountsPerTurn * kCapstan_m / kDrum_m[joint];
}
}  // namespace

Vector jointAngles(const Vector& counts) {
  Vector angles{0.0, 0.0, 0.5 * kPi};
  for (std::size_t i = 0; i < 3; ++i) angles[i] += kCountSign[i] * perCount(i) * counts[i];
  return angles;
}

Vector tip(const Vector& a) {
  const double reach = kLb_m * std::sin(a[1]) + kLc_m * std::sin(a[2]);
  return {std::cos(a[0]) * reach - kOrigin_m[0], std::sin(a[0]) * reach - kOrigin_m[1],
          kLn_m + kLb_m * std::cos(a[1]) - kLc_m * std::cos(a[2]) - kOrigin_m[2]};
}

Matrix jacobian(const Vector& a) {
  const double sa = std::sin(a[0]), ca = std::cos(a[0]), sb = std::sin(a[1]), cb = std::cos(a[1]);
  const double sc = std::sin(a[2]), cc = std::cos(a[2]), reach = kLb_m * sb + kLc_m * sc;
  return {Vector{-sa * reach, kLb_m * ca * cb, kLc_m * ca * cc},
          Vector{ca * reach, kLb_m * sa * cb, kLc_m * sa * cc},
          Vector{0.0, -kLb_m * sb, kLc_m * sc}};
}

Vector jointTorques(const Vector& angles, const Vector& force_N) {
  const Matrix j = jacobian(angles);
  Vector torques{};
  for (std::size_t joint = 0; joint < 3; ++joint) {
    for (std::size_t axis = 0; axis < 3; ++axis) torques[joint] += j[axis][joint] * force_N[axis];
  }
  return torques;
}

Vector gravityTorques(const Vector& a) {
  return {0.0, -kGravity_m_s2 * std::sin(a[1]) * (kMassB_kg * kCentreB_m + kMassC_kg * kLb_m),
          kGravity_m_s2 * std::sin(a[2]) * kMassC_kg * kCentreC_m};
}

Vector currents(const Vector& torques_Nm) {
  Vector amps{};
  double most = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    amps[i] = kTorqueSign[i] * torques_Nm[i] * kCapstan_m / kDrum_m[i] / kTorque_Nm_per_A;
    most = std::max(most, std::abs(amps[i]));
  }
  if (most > kMost_A) {
    for (double& amp : amps) amp *= kMost_A / most;
  }
  return amps;
}

}  // namespace trephine::woodenhaptics
