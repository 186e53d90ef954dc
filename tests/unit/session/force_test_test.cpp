// The force by which a person tells that an arm works.
#include "session/force_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace trephine {
namespace {

using Phase = ForceTest::Phase;
constexpr double kTick_s = 1e-3;

// A hand that moves the arm this far and then keeps still.
struct Held {
  ForceTest test;
  Vec3 at_m{0.0};
  bool button = false, no_hand = false, lost = false;

  double run(double seconds) {
    double force_N = 0.0;
    for (int i = 0; i < int(seconds / kTick_s + 0.5); ++i) {
      force_N = test.tick({at_m, button, no_hand, lost}, kTick_s);
    }
    return force_N;
  }
  void moveSlowly(double by_m) {
    for (int i = 0; i < 100; ++i) {
      at_m.x += by_m / 100.0;
      run(kTick_s);
    }
  }
};

TEST(ForceTest, GivesNothingUntilItIsAskedForAndAHandIsThere) {
  Held arm;
  arm.moveSlowly(0.02);
  EXPECT_EQ(arm.run(1.0), 0.0);
  arm.test.ask(1.0);
  EXPECT_EQ(arm.run(20.0), 0.0);
  EXPECT_EQ(arm.test.phase(), Phase::waiting);
  arm.moveSlowly(0.004);
  EXPECT_EQ(arm.run(1.0), 0.0) << "a tremble is no hand";
  arm.moveSlowly(0.002);
  EXPECT_GT(arm.run(1.0), 0.0);
}

TEST(ForceTest, RisesOverThreeSecondsHoldsForTwoAndIsGone) {
  Held arm;
  arm.test.ask(1.5);
  arm.run(kTick_s);
  arm.button = true;
  arm.run(kTick_s);
  double last_N = 0.0, most_step_N = 0.0;
  for (int i = 1; i <= 6000; ++i) {
    const double now_N = arm.run(kTick_s);
    most_step_N = std::max(most_step_N, std::abs(now_N - last_N));
    ASSERT_GE(now_N, 0.0);
    ASSERT_LE(now_N, 1.5);
    if (i == 1500) {
      EXPECT_NEAR(now_N, 0.75, 1e-3);
    }
    if (i == 4000) {
      EXPECT_EQ(now_N, 1.5);
    }
    last_N = now_N;
  }
  EXPECT_LT(most_step_N, 2e-3) << "never at once";
  EXPECT_EQ(arm.run(1.0), 0.0);
  EXPECT_EQ(arm.test.phase(), Phase::done);
}

TEST(ForceTest, WhoeverLetsGoOfTheButtonHasNoForceInThatTick) {
  Held arm;
  arm.test.ask(1.0);
  arm.button = true;
  ASSERT_GT(arm.run(2.0), 0.5);
  arm.button = false;
  EXPECT_EQ(arm.run(kTick_s), 0.0);
  EXPECT_EQ(arm.test.phase(), Phase::done);
  arm.button = true;
  EXPECT_EQ(arm.run(1.0), 0.0) << "asked for anew, or not at all";
}

TEST(ForceTest, AnArmThatFliesAwayOrIsLostHasNone) {
  Held arm;
  arm.test.ask(1.0);
  arm.moveSlowly(0.006);
  ASSERT_GT(arm.run(2.0), 0.5);
  double force_N = 1.0;
  for (int i = 0; i < 30; ++i) {
    arm.at_m.y += 0.001;  // 1 m/s
    force_N = arm.run(kTick_s);
  }
  EXPECT_EQ(force_N, 0.0);
  EXPECT_EQ(arm.test.phase(), Phase::lost);

  Held other;
  other.test.ask(1.0);
  other.button = true;
  ASSERT_GT(other.run(2.0), 0.5);
  other.lost = true;
  EXPECT_EQ(other.run(kTick_s), 0.0);
}

TEST(ForceTest, AnArmInItsHolderHasNoneAndOneThatNobodyTakesIsGivenUp) {
  Held arm;
  arm.test.ask(1.0);
  arm.no_hand = true;
  arm.moveSlowly(0.02);
  EXPECT_EQ(arm.run(1.0), 0.0) << "whatever its place says";
  EXPECT_EQ(arm.test.phase(), Phase::waiting);
  arm.no_hand = false;
  EXPECT_EQ(arm.run(1.0), 0.0) << "from where it was taken";
  arm.moveSlowly(0.006);
  ASSERT_GT(arm.run(2.0), 0.5);
  arm.no_hand = true;
  EXPECT_EQ(arm.run(kTick_s), 0.0);
  EXPECT_EQ(arm.test.phase(), Phase::done);

  Held nobody;
  nobody.test.ask(1.0);
  nobody.run(31.0);
  nobody.button = true;
  EXPECT_EQ(nobody.run(2.0), 0.0);
  EXPECT_EQ(nobody.test.phase(), Phase::off);
}

TEST(ForceTest, CanBeEndedAtAnyTime) {
  Held arm;
  arm.test.ask(1.0);
  arm.button = true;
  ASSERT_GT(arm.run(2.0), 0.5);
  arm.test.end();
  EXPECT_EQ(arm.run(kTick_s), 0.0);
}

}  // namespace
}  // namespace trephine
