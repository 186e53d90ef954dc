#include "lab/trades/trade_velocity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lab/trades/trade_arm.h"
#include "lab/trades/trade_knobs.h"

namespace trephine {
namespace {

TEST(BackwardDifference, IsTheStepOverThePeriodFromTheSecondSampleOn) {
  BackwardDifference d(0.001);
  EXPECT_EQ(d.update(5.0), 0.0);
  EXPECT_NEAR(d.update(5.002), 2.0, 1e-9);
  EXPECT_NEAR(d.update(5.001), -1.0, 1e-9);
}

TEST(LowPass, GoesTheShareOfTheWayThatItsCutoffSays) {
  // At 500 / pi Hz, 1 / (2 pi f) is a period of 1 ms, so that half of each step is taken.
  LowPassDifference d(0.001, 500.0 / 3.14159265358979323846);
  d.update(0.0);
  EXPECT_NEAR(d.update(0.004), 2.0, 1e-9);
  EXPECT_NEAR(d.update(0.004), 1.0, 1e-9);
  EXPECT_NEAR(d.update(0.004), 0.5, 1e-9);
}

TEST(AdaptiveWindow, TakesTheLongestWindowThatIsALineWithinTheBand) {
  AdaptiveWindow w(0.001, 1.0);
  EXPECT_EQ(w.update(0.0), 0.0);
  EXPECT_NEAR(w.update(1.0), 1000.0, 1e-9);
  EXPECT_NEAR(w.update(1.0), 500.0, 1e-9);  // 0 1 1: off the line by 0.5
  EXPECT_NEAR(w.update(2.0), 2.0 / 3.0 * 1e3, 1e-9);
  // 0 1 1 2 9: off the line from the first by 2.5 and more; so are 1 1 2 9 (off by 8/3) and 1 2 9
  // (by 3). What is left is one step.
  EXPECT_NEAR(w.update(9.0), 7000.0, 1e-9);
}

TEST(AdaptiveWindow, StopsAtTheFirstWindowThatDoesNotFitAndAtItsLongest) {
  AdaptiveWindow w(1.0, 0.1);
  for (int n = 0; n < 10; ++n) w.update(5.0);
  for (int n = 0; n < 500; ++n) w.update(5.0 + 2.0 * n);
  EXPECT_NEAR(w.update(5.0 + 2.0 * 500), 2.0, 1e-12);
  AdaptiveWindow at_rest(1.0, 0.5);
  for (int n = 0; n < 200; ++n) at_rest.update(0.0);
  EXPECT_NEAR(at_rest.update(1.0), 1.0 / 2.0, 1e-12);  // 0 0 1 fits in 0.5, 0 0 0 1 does not
}

TEST(AdaptiveWindow, DoesNotLookBeyondAWindowThatDoesNotFit) {
  // 0 -0.5 0.5 0: of three 0.5 is off by 0.75; of all four no sample is off by more than 0.5.
  AdaptiveWindow w(1.0, 0.5);
  for (double x : {0.0, -0.5, 0.5}) w.update(x);
  EXPECT_NEAR(w.update(0.0), -0.5, 1e-12);
}

TEST(AdaptiveWindow, IsNoLongerThanItsMost) {
  AdaptiveWindow w(1.0, 1e9);
  double slope = 0.0;
  for (int n = 0; n < 500; ++n) slope = w.update(double(n) * n);
  EXPECT_NEAR(slope, 2.0 * 499 - double(AdaptiveWindow::kMost), 1e-9);
}

TEST(Lag, OfADelayedSignalIsItsDelay) {
  constexpr double kFine = 1e-4, kPeriod = 1e-3;
  std::vector<double> truth, estimate;
  for (int i = 0; i < 20000; ++i) truth.push_back(std::sin(2.0 * M_PI * 3.0 * i * kFine));
  for (int n = 0; n < 2000; ++n) {
    estimate.push_back(n * 10 >= 37 ? truth[std::size_t(n * 10 - 37)] : 0.0);
  }
  EXPECT_NEAR(lagOf(estimate, kPeriod, truth, kFine, 0.05), 3.7e-3, 1e-9);
}

TEST(Lag, OfABackwardDifferenceIsHalfAPeriod) {
  constexpr double kFine = 1e-4, kPeriod = 1e-3;
  std::vector<double> truth, estimate;
  BackwardDifference d(kPeriod);
  for (int i = 0; i < 20000; ++i) truth.push_back(20.0 * std::cos(20.0 * i * kFine));
  for (int n = 0; n < 2000; ++n) estimate.push_back(d.update(std::sin(20.0 * n * kPeriod)));
  EXPECT_NEAR(lagOf(estimate, kPeriod, truth, kFine, 0.05), 5e-4, 1e-9);
}

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

TEST(VelocityKnob, FindsTheBackwardDifferenceQuickAndNoisyTheLowPassLate) {
  const TradeRows rows = tradeVelocity({}, Progress());
  ASSERT_TRUE(rows);
  ASSERT_EQ(rows->size(), 5u);
  const TradeRow &difference = (*rows)[0], &slow = (*rows)[2];
  EXPECT_NEAR(difference.cost, 0.5, 0.11);
  // A count of 0.055 mm in 1 ms is 55 mm/s; rounding evenly spread makes sqrt(q^2 / 6) / T of it.
  EXPECT_GT(difference.error, 5.0);
  EXPECT_LT(difference.error, 25.0);
  // 1 / (2 pi 20 Hz) is 8 ms.
  EXPECT_NEAR(slow.cost, 8.5, 1.0);
}

}  // namespace
}  // namespace trephine
