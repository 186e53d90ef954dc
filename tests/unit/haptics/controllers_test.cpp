#include "haptics/controllers.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

constexpr double kT = 0.001;

ControllerInput given(const Vec3& demanded_N, const Vec3& velocity_m_s) {
  ControllerInput in;
  in.demanded_N = demanded_N;
  in.velocity_m_s = velocity_m_s;
  in.touching = true;
  in.period_s = kT;
  return in;
}

TEST(OffController, PassesTheDemandedForce) {
  OffController off;
  EXPECT_EQ(off.bound(given({1, 2, 3}, {4, 5, 6})), Vec3(1, 2, 3));
}

// Eqs. 7-9 by hand for one axis, then against the controller.
TEST(SeedController, FollowsEquations7To9OnOneAxis) {
  SeedController seed;
  // Port force is the opposite of the arm's. Tick 1: f = 1, v = -0.1: E = -1e-4 J.
  Vec3 out = seed.bound(given({-1, 0, 0}, {-0.1, 0, 0}));
  EXPECT_NEAR(seed.observer_J, -1e-4, 1e-18);
  const double alpha1 = 1e-4 / (kT * 0.01);  // 10 N s/m
  EXPECT_NEAR(seed.last_alpha, alpha1, 1e-9);
  EXPECT_NEAR(-out.x, 1.0 + alpha1 * -0.1, 1e-9) << "f_c = f + alpha v = 0";
  // Tick 2: f = 2, v = 0.05: E = -1e-4 + (2 * 0.05 + 10 * 0.01) T = 1e-4, so alpha = 0.
  out = seed.bound(given({-2, 0, 0}, {0.05, 0, 0}));
  EXPECT_NEAR(seed.observer_J, 1e-4, 1e-15);
  EXPECT_EQ(seed.last_alpha, 0.0);
  EXPECT_EQ(-out.x, 2.0);
}

TEST(SeedController, CompensatesAlongTheForceOnly) {
  SeedController seed;
  const Vec3 out = seed.bound(given({-1, 0, 0}, {-0.1, 0.3, 0}));
  EXPECT_GT(seed.last_alpha, 0.0);
  EXPECT_EQ(out.y, 0.0);
  EXPECT_EQ(out.z, 0.0);
}

TEST(SeedController, AddsNothingWhileTheForceIsZero) {
  SeedController seed;
  seed.observer_J = -1.0;
  EXPECT_EQ(seed.bound(given({0, 0, 0}, {0.1, 0.1, 0})), Vec3(0.0));
  EXPECT_EQ(seed.last_alpha, 0.0);
}

TEST(SeedController, IsBlindToADamper) {
  SeedController seed;
  double v = 0.02;
  for (int i = 0; i < 1000; ++i, v = -v) {  // a limit cycle: force -b v against v
    const Vec3 demanded(-40.0 * v, 0, 0);
    EXPECT_EQ(seed.bound(given(demanded, {v, 0, 0})), demanded);
  }
  EXPECT_GT(seed.observer_J, 0.0);
}

TEST(Controllers, ForgetTheirEnergy) {
  SeedController seed;
  seed.bound(given({-1, 0, 0}, {-0.1, 0, 0}));
  seed.forget();
  EXPECT_EQ(seed.observer_J, 0.0);
  EXPECT_EQ(seed.last_alpha, 0.0);
}

}  // namespace
}  // namespace trephine
