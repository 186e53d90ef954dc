#include "wooden_arm.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trephine::test {

using namespace woodenhaptics;

Vector countsAt(const Vector& angles) {
  Vector counts = angles;
  counts[2] -= 0.5 * std::numbers::pi;
  for (std::size_t i = 0; i < 3; ++i) {
    const double turns = counts[i] / (2.0 * std::numbers::pi);
    counts[i] = kCountSign[i] * turns * kCountsPerTurn * kDrum_m[i] / kCapstan_m;
  }
  return counts;
}

bool anglesAt(const Vector& tip_m, Vector& angles) {
  const double x = tip_m[0] + kOrigin_m[0], y = tip_m[1] + kOrigin_m[1];
  const double up = tip_m[2] + kOrigin_m[2] - kLn_m, reach = std::hypot(x, y);
  // Links b (from the shoulder) and c (from the elbow) reach (reach, up).
  const double square = reach * reach + up * up, far = std::sqrt(square);
  if (far > kLb_m + kLc_m || far < kLc_m - kLb_m || far == 0.0) return false;
  const double cosine = (square + kLb_m * kLb_m - kLc_m * kLc_m) / (2.0 * far * kLb_m);
  const double b = std::atan2(reach, up) - std::acos(std::clamp(cosine, -1.0, 1.0));
  const double c = std::atan2(reach - kLb_m * std::sin(b), -(up - kLb_m * std::cos(b)));
  angles = {std::atan2(y, x), b, c};
  return true;
}

Vector torquesOf(const Vector& currents_A) {
  Vector torques{};
  for (std::size_t i = 0; i < 3; ++i) {
    torques[i] = kTorqueSign[i] * currents_A[i] * kTorque_Nm_per_A * kDrum_m[i] / kCapstan_m;
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

}  // namespace trephine::test
