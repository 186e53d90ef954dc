#include "kinematics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trephine::woodenhaptics {

namespace {
constexpr double kPi = std::numbers::pi;
// The way a joint turns with its motor.
constexpr Vector kCountSign{-1.0, -1.0, -1.0};
constexpr Vector kTorqueSign{1.0, -1.0, -1.0};

double perCount(std::size_t joint) {
  return 2.0 * kPi / kCountsPerTurn * kCapstan_m / kDrum_m[joint];
}
}  // namespace

Vector jointAngles(const Vector& counts) {
  Vector angles{0.0, 0.0, 0.5 * kPi};
  for (std::size_t i = 0; i < 3; ++i) angles[i] += kCountSign[i] * perCount(i) * counts[i];
  return angles;
}

Vector countsAt(const Vector& angles) {
  Vector counts = angles;
  counts[2] -= 0.5 * kPi;
  for (std::size_t i = 0; i < 3; ++i) counts[i] *= kCountSign[i] / perCount(i);
  return counts;
}

Vector tip(const Vector& a) {
  const double reach = kLb_m * std::sin(a[1]) + kLc_m * std::sin(a[2]);
  return {std::cos(a[0]) * reach - kOrigin_m[0], std::sin(a[0]) * reach - kOrigin_m[1],
          kLn_m + kLb_m * std::cos(a[1]) - kLc_m * std::cos(a[2]) - kOrigin_m[2]};
}

bool anglesAt(const Vector& tip_m, Vector& angles) {
  const double x = tip_m[0] + kOrigin_m[0], y = tip_m[1] + kOrigin_m[1];
  const double up = tip_m[2] + kOrigin_m[2] - kLn_m, reach = std::hypot(x, y);
  // Links b (from the shoulder) and c (its lower end, from the elbow) reach (reach, up).
  const double square = reach * reach + up * up, far = std::sqrt(square);
  if (far > kLb_m + kLc_m || far < kLc_m - kLb_m || far == 0.0) return false;
  const double at_shoulder = std::acos(
      std::clamp((square + kLb_m * kLb_m - kLc_m * kLc_m) / (2.0 * far * kLb_m), -1.0, 1.0));
  const double b = std::atan2(reach, up) - at_shoulder;
  const double c = std::atan2(reach - kLb_m * std::sin(b), -(up - kLb_m * std::cos(b)));
  angles = {std::atan2(y, x), b, c};
  return true;
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

Vector forceOf(const Vector& angles, const Vector& torques_Nm) {
  // J^T F = tau by Cramer's rule: the rows of J^T are the columns of J.
  const Matrix j = jacobian(angles);
  const auto column = [&](std::size_t c) { return Vector{j[0][c], j[1][c], j[2][c]}; };
  const auto cross = [](const Vector& u, const Vector& v) {
    return Vector{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  };
  const Vector a = column(0), b = column(1), c = column(2);
  const Vector bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const double volume = a[0] * bc[0] + a[1] * bc[1] + a[2] * bc[2];
  if (std::abs(volume) < 1e-9) return {};
  Vector force{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    force[axis] =
        (torques_Nm[0] * bc[axis] + torques_Nm[1] * ca[axis] + torques_Nm[2] * ab[axis]) / volume;
  }
  return force;
}

double potential_J(const Vector& a) {
  return kGravity_m_s2 * (kMassB_kg * kCentreB_m * std::cos(a[1]) +
                          kMassC_kg * (kLb_m * std::cos(a[1]) - kCentreC_m * std::cos(a[2])));
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

Vector torquesOf(const Vector& currents_A) {
  Vector torques{};
  for (std::size_t i = 0; i < 3; ++i) {
    torques[i] = kTorqueSign[i] * currents_A[i] * kTorque_Nm_per_A * kDrum_m[i] / kCapstan_m;
  }
  return torques;
}

}  // namespace trephine::woodenhaptics
