#include "machine/trades/trade_arm.h"

#include <gtest/gtest.h>

#include <cmath>

namespace trephine {
namespace {

TEST(ArmInHand, SwingsAsASpringAndAMassDo) {
  ArmInHand arm;
  arm.damping_Ns_per_m = arm.hand_damping = 0.0;
  arm.mass_kg = 1.0;
  arm.hand_stiffness = 4.0 * M_PI * M_PI;  // a period of 1 s
  arm.position_m = Vec3(0.01, 0.0, 0.0);
  for (int n = 0; n < 10000; ++n) arm.step(Vec3(0.0), Vec3(0.0), 1e-4);
  EXPECT_NEAR(arm.position_m.x, 0.01, 1e-6);
  for (int n = 0; n < 5000; ++n) arm.step(Vec3(0.0), Vec3(0.0), 1e-4);
  EXPECT_NEAR(arm.position_m.x, -0.01, 1e-6);
}

TEST(ArmInHand, ComesToRestWhereForceAndHandAreEqualAndReadsWholeSteps) {
  ArmInHand arm;
  for (int n = 0; n < 40000; ++n) arm.step(Vec3(0.3, 0.0, 0.0), Vec3(0.002, 0.0, 0.0), 1e-4);
  EXPECT_NEAR(arm.position_m.x, 0.002 + 0.3 / 300.0, 1e-9);
  EXPECT_NEAR(arm.velocity_m_s.x, 0.0, 1e-9);
  EXPECT_NEAR(arm.reading_m().x, 55 * 5.5e-5, 1e-12);
}

}  // namespace
}  // namespace trephine
