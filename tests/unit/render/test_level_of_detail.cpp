#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/level_of_detail.h"

using namespace trephine;

namespace {

// A machine that draws a full frame in `full_ms`, and less the fewer samples there are.
double frame_ms(double full_ms, const LevelOfDetail& level) {
  return 3.0 + full_ms / (level.pixelStep() * level.pixelStep() * level.rayStep());
}

}  // namespace

TEST(LevelOfDetail, AFastMachineMovesAtFullQuality) {
  LevelOfDetail level;
  level.stillFrameTook(12.0);
  EXPECT_EQ(level.pixelStep(), 1.0);
  EXPECT_EQ(level.rayStep(), 1.0);
}

TEST(LevelOfDetail, ASlowMachineKeepsFifteenFramesASecondFromTheFirstMovingFrame) {
  for (double full_ms : {80.0, 340.0, 900.0}) {
    LevelOfDetail level;
    level.stillFrameTook(full_ms);
    for (int frame = 0; frame < 50; ++frame) {
      const double ms = frame_ms(full_ms, level);
      EXPECT_LE(ms, 1000.0 / 15.0) << full_ms << " at frame " << frame;
      level.movingFrameTook(ms);
    }
  }
}

TEST(LevelOfDetail, WithoutAStillFrameItFindsItsLevelInAFewFrames) {
  LevelOfDetail level;
  for (int frame = 0; frame < 6; ++frame) level.movingFrameTook(frame_ms(600.0, level));
  EXPECT_LE(frame_ms(600.0, level), 1000.0 / 15.0);
}

TEST(LevelOfDetail, ItBecomesFinerWhenThereIsTimeAndThenStaysPut) {
  LevelOfDetail level;
  level.stillFrameTook(2000.0);
  const double coarse = level.pixelStep();
  for (int frame = 0; frame < 30; ++frame) level.movingFrameTook(frame_ms(100.0, level));
  EXPECT_LT(level.pixelStep(), coarse);
  const double settled = level.pixelStep();
  for (int frame = 0; frame < 30; ++frame) {
    level.movingFrameTook(frame_ms(100.0, level));
    EXPECT_EQ(level.pixelStep(), settled);
  }
}

TEST(LevelOfDetail, AnEnlargedViewKeepsItsFramesFromTheFirstOne) {
  LevelOfDetail level;
  level.stillFrameTook(150.0);
  for (int frame = 0; frame < 10; ++frame) level.movingFrameTook(frame_ms(150.0, level));
  level.pixelsChanged(4.0);
  EXPECT_LE(frame_ms(600.0, level), 1000.0 / 15.0);
  EXPECT_NEAR(level.stillFrame_ms(), 600.0, 1e-9);
  const double large = level.pixelStep();
  level.pixelsChanged(0.25);
  EXPECT_LT(level.pixelStep(), large);
  for (const double nothing : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const double before = level.pixelStep();
    level.pixelsChanged(nothing);
    EXPECT_EQ(level.pixelStep(), before);
  }
}

TEST(LevelOfDetail, OneSlowFrameChangesNothingAndTwoAreFollowedByFinerOnesAgain) {
  LevelOfDetail level;
  level.stillFrameTook(600.0);
  for (int frame = 0; frame < 30; ++frame) level.movingFrameTook(frame_ms(600.0, level));
  const double settled = level.pixelStep();
  level.movingFrameTook(400.0);
  level.movingFrameTook(frame_ms(600.0, level));
  EXPECT_EQ(level.pixelStep(), settled);
  for (int frame = 0; frame < 2; ++frame) level.movingFrameTook(400.0);
  EXPECT_GT(level.pixelStep(), settled);
  for (int frame = 0; frame < 30; ++frame) level.movingFrameTook(frame_ms(600.0, level));
  EXPECT_LE(level.pixelStep(), settled + 0.25);
}

TEST(LevelOfDetail, BlocksOfOverFourPixelsComeOnlyWhereAFrameWouldKeepTheWindowForLong) {
  for (const double full_ms : {2200.0, 1200.0, 6000.0}) {
    LevelOfDetail level;
    level.stillFrameTook(full_ms);
    for (int frame = 0; frame < 40; ++frame) level.movingFrameTook(frame_ms(full_ms, level));
    const double ms = frame_ms(full_ms, level);
    EXPECT_LE(ms, 55.0) << full_ms;
    if (level.pixelStep() > 4.0) {
      EXPECT_GT(3.0 + full_ms / 32.0, 50.0) << full_ms;
    }
    const double settled = level.pixelStep();
    for (int frame = 0; frame < 10; ++frame) level.movingFrameTook(frame_ms(full_ms, level));
    EXPECT_EQ(level.pixelStep(), settled) << full_ms;
  }
}

TEST(LevelOfDetail, ItNeverLeavesItsBounds) {
  LevelOfDetail level;
  for (int frame = 0; frame < 2; ++frame) level.movingFrameTook(1e9);
  EXPECT_EQ(level.pixelStep(), LevelOfDetail::kCoarsest);
  level.movingFrameTook(std::nan(""));
  level.stillFrameTook(-1.0);
  level.movingFrameTook(std::numeric_limits<double>::infinity());
  EXPECT_EQ(level.pixelStep(), LevelOfDetail::kCoarsest);
  for (int frame = 0; frame < 100; ++frame) level.movingFrameTook(0.01);
  EXPECT_EQ(level.pixelStep(), 1.0);
}

TEST(LevelOfDetail, AfterMovementAPictureInBetweenComesOnlyWhereFullQualityWouldTakeLong) {
  LevelOfDetail quick, slow;
  quick.stillFrameTook(700.0);
  EXPECT_EQ(quick.finerThan(quick.pixelStep()), 1.0);
  slow.stillFrameTook(4000.0);
  const double between = slow.finerThan(slow.pixelStep());
  EXPECT_GT(between, 1.0);
  EXPECT_LT(between, slow.pixelStep());
  EXPECT_LE(frame_ms(4000.0, slow) * slow.pixelStep() * slow.pixelStep() / (between * between),
            500.0);
  EXPECT_EQ(slow.finerThan(between), 1.0);
}

TEST(StripPixels, AStripTakesTheTimeThatIsLeft) {
  EXPECT_EQ(nextStripPixels(4000, 20.0, 20.0), 4000);
  EXPECT_EQ(nextStripPixels(4000, 20.0, 10.0), 2000);
  EXPECT_EQ(nextStripPixels(4000, 20.0, 1000.0), 6000);  // the next may be dearer
  EXPECT_EQ(nextStripPixels(4000, 20.0, -5.0), 0);
  EXPECT_EQ(nextStripPixels(0, 0.0, 50.0), 0);
}
