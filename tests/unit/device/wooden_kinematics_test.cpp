// The geometry of the open arm: there and back, and against differences of itself.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "conformance/wooden_arm.h"

namespace trephine::woodenhaptics {
namespace {

using test::anglesAt, test::countsAt, test::forceOf, test::potential_J, test::torquesOf;

// Tips within the arm's box.
std::vector<Vector> tips() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> x(-0.06, 0.06), y(-0.10, 0.10), z(-0.08, 0.08);
  std::vector<Vector> all;
  for (int i = 0; i < 500; ++i) all.push_back({x(random), y(random), z(random)});
  return all;
}

Vector anglesOf(const Vector& tip_m) {
  Vector angles{};
  EXPECT_TRUE(anglesAt(tip_m, angles)) << tip_m[0] << ' ' << tip_m[1] << ' ' << tip_m[2];
  return angles;
}

TEST(WoodenKinematics, ATipLeadsToAnglesThatLeadToIt) {
  for (const Vector& wanted : tips()) {
    const Vector angles = anglesOf(wanted), back = tip(angles);
    const Vector counted = jointAngles(countsAt(angles));
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_NEAR(back[i], wanted[i], 1e-9);
      ASSERT_NEAR(counted[i], angles[i], 1e-9);
    }
  }
  Vector none{};
  EXPECT_FALSE(anglesAt({1.0, 0.0, 0.0}, none)) << "beyond its links";
}

TEST(WoodenKinematics, SwitchedOnItsUpperLinkIsUprightAndTheLowerOneLevel) {
  const Vector home = tip(jointAngles({0.0, 0.0, 0.0}));
  EXPECT_NEAR(home[0], kLc_m - kOrigin_m[0], 1e-12);
  EXPECT_NEAR(home[1], 0.0, 1e-12);
  EXPECT_NEAR(home[2], kLn_m + kLb_m - kOrigin_m[2], 1e-12);
}

TEST(WoodenKinematics, TheJacobianIsTheDifferenceOfTheTip) {
  for (const Vector& at : tips()) {
    const Vector angles = anglesOf(at);
    const Matrix exact = jacobian(angles);
    constexpr double h = 1e-5;
    for (std::size_t joint = 0; joint < 3; ++joint) {
      Vector more = angles, less = angles;
      more[joint] += h;
      less[joint] -= h;
      const Vector a = tip(more), b = tip(less);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ASSERT_NEAR(exact[axis][joint], (a[axis] - b[axis]) / (2.0 * h), 1e-9);
      }
    }
  }
}

TEST(WoodenKinematics, GravityIsTheGradientOfTheLinksPotential) {
  for (const Vector& at : tips()) {
    const Vector angles = anglesOf(at), exact = gravityTorques(angles);
    constexpr double h = 1e-5;
    for (std::size_t joint = 0; joint < 3; ++joint) {
      Vector more = angles, less = angles;
      more[joint] += h;
      less[joint] -= h;
      ASSERT_NEAR(exact[joint], (potential_J(more) - potential_J(less)) / (2.0 * h), 1e-9);
    }
  }
}

TEST(WoodenKinematics, AForceBecomesCurrentsThatMakeIt) {
  for (const Vector& at : tips()) {
    const Vector angles = anglesOf(at), force{0.4, -0.7, 1.1};
    const Vector amps = currents(jointTorques(angles, force));
    const Vector made = forceOf(angles, torquesOf(amps));
    for (std::size_t i = 0; i < 3; ++i) ASSERT_NEAR(made[i], force[i], 1e-9);
    // What a motor cannot give shortens the force and keeps its direction.
    const Vector strong{40.0, -70.0, 110.0}, weaker = currents(jointTorques(angles, strong));
    for (double amp : weaker) ASSERT_LE(std::abs(amp), kMost_A * (1.0 + 1e-12));
    const Vector short_of = forceOf(angles, torquesOf(weaker));
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_NEAR(short_of[i] / short_of[0], strong[i] / strong[0], 1e-9);
    }
  }
}

TEST(WoodenKinematics, ACountIsAboutATwentiethOfAMillimetreAtTheTip) {
  double most_m = 0.0, least_m = 1.0;
  const Vector counts = countsAt(anglesOf({0.0, 0.0, 0.0})), at = tip(jointAngles(counts));
  for (std::size_t joint = 0; joint < 3; ++joint) {
    Vector next = counts;
    next[joint] += 1.0;
    const Vector moved = tip(jointAngles(next));
    const double step_m = std::hypot(moved[0] - at[0], moved[1] - at[1], moved[2] - at[2]);
    most_m = std::max(most_m, step_m);
    least_m = std::min(least_m, step_m);
  }
  EXPECT_NEAR(most_m, 6.4e-5, 0.3e-5);
  EXPECT_NEAR(least_m, 4.3e-5, 0.3e-5);
}

}  // namespace
}  // namespace trephine::woodenhaptics
