#include "lab/touch/sliding_measurement.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

const Vec3 kUp(0.0, 0.0, 1.0);

TEST(Sliding, JudgesDirectionsStepsAndDepthByHand) {
  // Angles 0, 90, 0 and 180 degrees; one step of sqrt(1 + 9), and none from path to path.
  const std::vector<std::vector<SlidingTick>> paths{
      {{{0.0, 0.0, 1.0}, kUp}, {{3.0, 0.0, 0.0}, kUp}},
      {{{0.0, 0.0, 2.0}, kUp}},
      {{{0.0, 0.0, -6.0}, kUp}}};
  const SlidingMeasurement m = judgeSliding(paths, 2.0);
  EXPECT_EQ(m.ticks, 4u);
  EXPECT_NEAR(m.direction_median_deg, 0.0, 1e-9);
  EXPECT_NEAR(m.direction_p99_deg, 180.0, 1e-9);
  EXPECT_NEAR(m.step_p99_percent, 100.0 * std::sqrt(10.0) / 3.0, 1e-9);
  EXPECT_NEAR(m.depth_error_percent, 50.0, 1e-9);
}

TEST(Sliding, AForceOfNothingIsAsWrongAsCanBe) {
  const SlidingMeasurement m = judgeSliding({{{Vec3(0.0), kUp}, {Vec3(0.0), kUp}}}, 0.25);
  EXPECT_NEAR(m.direction_median_deg, 180.0, 1e-9);
  EXPECT_NEAR(m.step_p99_percent, 100.0, 1e-9);
  EXPECT_NEAR(m.depth_error_percent, -100.0, 1e-9);
}

TEST(Sliding, OverAFineShellThePushPointsOutAndIsSmooth) {
  SlidingOptions options;
  options.grid = 128;
  options.paths = 3;
  options.seconds = 0.5;
  const Result<SlidingMeasurement> m = measureSliding(options, Progress());
  ASSERT_TRUE(m) << m.error().sentence();
  EXPECT_EQ(m->ticks, 1500u);
  EXPECT_LT(m->direction_median_deg, 6.0);
  EXPECT_GT(m->direction_median_deg, 0.01);
  EXPECT_LT(m->step_p99_percent, 10.0);  // on voxels as wide as the ball's radius
  EXPECT_LT(std::abs(m->depth_error_percent), 60.0);
}

TEST(Sliding, NoiseMakesItWorse) {
  SlidingOptions options;
  options.grid = 128;
  options.paths = 2;
  options.seconds = 0.5;
  options.noise_hu = 0.0;
  const Result<SlidingMeasurement> quiet = measureSliding(options, Progress());
  options.noise_hu = 300.0;
  const Result<SlidingMeasurement> noisy = measureSliding(options, Progress());
  ASSERT_TRUE(quiet && noisy);
  EXPECT_GT(noisy->direction_median_deg, quiet->direction_median_deg);
}

TEST(Sliding, RefusesWhatCannotBeAndStops) {
  for (const SlidingOptions& bad :
       {SlidingOptions{8, 1, 1.0, 0.0}, SlidingOptions{64, 0, 1.0, 0.0},
        SlidingOptions{64, 1, 0.0, 0.0}, SlidingOptions{64, 1, std::nan(""), 0.0},
        SlidingOptions{64, 1, 1.0, -1.0}}) {
    const Result<SlidingMeasurement> m = measureSliding(bad, Progress());
    ASSERT_FALSE(m);
    EXPECT_EQ(m.error().code.str(), "BAD_ARGUMENT");
  }
  Progress progress;
  progress.cancel();
  const Result<SlidingMeasurement> m = measureSliding({64, 1, 1.0, 0.0}, progress);
  ASSERT_FALSE(m);
  EXPECT_EQ(m.error().code.str(), "CANCELLED");
}

}  // namespace
}  // namespace trephine
