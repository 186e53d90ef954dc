#include "haptics/safety.h"

#include <gtest/gtest.h>

#include <limits>

namespace trephine {
namespace {

constexpr double kT = 0.001;
constexpr double kStep = kSlew_N_per_s * kT;

TEST(ClampForce, KeepsTheDirectionAndTheLimit) {
  const Vec3 f = clampForce({30, 40, 0}, 3.3);
  EXPECT_NEAR(glm::length(f), 3.3, 1e-12);
  EXPECT_NEAR(f.y / f.x, 4.0 / 3.0, 1e-12);
  EXPECT_EQ(clampForce({1, 2, 0}, 3.3), Vec3(1, 2, 0));
}

TEST(ClampForce, AnswersEveryValueWithAFiniteForceWithinTheLimit) {
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double v : {0.0, 5e-324, 1e9, 1e300, -1e308, inf, -inf, nan}) {
    for (const Vec3& f : {Vec3(v, 0, 0), Vec3(v, 1, v), Vec3(v, v, v)}) {
      const Vec3 out = clampForce(f, 3.3);
      EXPECT_TRUE(isFinite(out));
      EXPECT_LE(glm::length(out), 3.3);
    }
  }
  EXPECT_EQ(clampForce({1, 0, 0}, 0.0), Vec3(0.0));
}

TEST(ClampForce, NeverExceedsTheLimitByRounding) {
  std::uint32_t random = 1;
  const auto next = [&random] {
    random = random * 1664525u + 1013904223u;
    return double(random) / 4294967296.0 * 20.0 - 10.0;
  };
  for (int i = 0; i < 100000; ++i) {
    ASSERT_LE(glm::length(clampForce({next(), next(), next()}, 3.3)), 3.3);
  }
}

TEST(SlewTowards, RisesByOneStepAndFallsAtOnce) {
  EXPECT_NEAR(slewTowards({1, 0, 0}, {3, 0, 0}, 0.05).x, 1.05, 1e-12);
  EXPECT_EQ(slewTowards({1, 0, 0}, {0.2, 0, 0}, 0.05), Vec3(0.2, 0, 0));
  EXPECT_EQ(slewTowards({1, 0, 0}, {0, 0, 0}, 0.05), Vec3(0.0));
}

TEST(SlewTowards, StartsFromNothingWhenTheForceTurnsAround) {
  EXPECT_NEAR(slewTowards({1, 0, 0}, {-3, 0, 0}, 0.05).x, -0.05, 1e-12);
  EXPECT_NEAR(slewTowards({1, 0, 0}, {0, 3, 0}, 0.05).y, 0.05, 1e-12);
}

TEST(LateGain, HoldsToFiveMillisecondsAndIsZeroAtTwenty) {
  EXPECT_EQ(lateGain(5'000'000), 1.0);
  EXPECT_EQ(lateGain(12'500'000), 0.5);
  EXPECT_EQ(lateGain(20'000'000), 0.0);
}

TEST(OutputLimiter, RisesSlowlyAfterAChangeUntilTheLawIsMet) {
  OutputLimiter limiter;
  double last = 0.0;
  int ticks = 0;
  for (; ticks < 100 && last < 2.0; ++ticks) {
    const double now = limiter.limit({2, 0, 0}, true, true, 0, kT).x;
    ASSERT_LE(now - last, kStep + 1e-12);
    last = now;
  }
  EXPECT_EQ(ticks, 40);
  for (int i = 0; i < 61; ++i) limiter.limit({2, 0, 0}, true, true, 0, kT);
  EXPECT_EQ(limiter.limit({3, 0, 0}, true, true, 0, kT).x, 3.0) << "met: follows the law";
  limiter.change();
  EXPECT_NEAR(limiter.limit({3.3, 0, 0}, true, true, 0, kT).x, 3.05, 1e-12);
}

TEST(OutputLimiter, SendsNothingAfterARestoreUntilTheToolIsOutThenRampsIn) {
  OutputLimiter limiter;
  for (int i = 0; i < 101; ++i) limiter.limit({2, 0, 0}, true, true, 0, kT);
  limiter.restored();
  for (int i = 0; i < 500; ++i) ASSERT_EQ(limiter.limit({2, 0, 0}, true, true, 0, kT), Vec3(0.0));
  limiter.limit({0, 0, 0}, false, true, 0, kT);  // out of tissue
  const double first = limiter.limit({2, 0, 0}, true, true, 0, kT).x;
  EXPECT_GT(first, 0.0);
  EXPECT_LE(first, kStep);
  double force = first;
  for (int i = 0; i < 200; ++i) force = limiter.limit({2, 0, 0}, true, true, 0, kT).x;
  EXPECT_EQ(force, 2.0) << "full after 0.2 s";
}

TEST(OutputLimiter, IsNotMetByALawThatHappensToBeZero) {
  OutputLimiter limiter;
  limiter.limit({0, 0, 0}, true, true, 0, kT);  // in tissue, at rest
  EXPECT_NEAR(limiter.limit({3, 0, 0}, true, true, 0, kT).x, kStep, 1e-12);
}

TEST(OutputLimiter, IsClosedInAPauseAndRisesSlowlyAfterIt) {
  OutputLimiter limiter;
  for (int i = 0; i < 100; ++i) limiter.limit({2, 0, 0}, true, true, 0, kT);
  EXPECT_EQ(limiter.limit({2, 0, 0}, true, false, 0, kT), Vec3(0.0));
  EXPECT_NEAR(limiter.limit({2, 0, 0}, true, true, 0, kT).x, kStep, 1e-12);
}

TEST(OutputLimiter, RampsDownWhenATickIsVeryLate) {
  OutputLimiter limiter;
  for (int i = 0; i < 101; ++i) limiter.limit({2, 0, 0}, true, true, 0, kT);
  EXPECT_EQ(limiter.limit({2, 0, 0}, true, true, 4'000'000, kT).x, 2.0);
  EXPECT_NEAR(limiter.limit({2, 0, 0}, true, true, 12'500'000, kT).x, 1.0, 1e-12);
  EXPECT_NEAR(limiter.limit({2, 0, 0}, true, true, 0, kT).x, 1.0 + kStep, 1e-12);
}

constexpr std::int64_t kMs = 1'000'000;

// On time for so long.
void calm(LatenessRule& rule, double seconds) {
  for (int i = 0; i < int(seconds / kT); ++i) rule.tick(0, false, kT);
}

TEST(LatenessRule, TakesTheForceAwayOnlyBeyondTwentyMilliseconds) {
  LatenessRule rule;
  rule.tick(20 * kMs, false, kT);
  EXPECT_FALSE(rule.away());
  rule.tick(20 * kMs + 1, false, kT);
  EXPECT_TRUE(rule.away());
  EXPECT_FALSE(rule.kept());
}

TEST(LatenessRule, GivesItBackAfterASecondWithoutATickMoreThanFiveMillisecondsLate) {
  LatenessRule rule;
  rule.tick(25 * kMs, false, kT);
  calm(rule, 0.9);
  rule.tick(6 * kMs, false, kT);
  calm(rule, 0.9);
  EXPECT_TRUE(rule.away()) << "the second began anew";
  rule.tick(5 * kMs, false, kT);
  calm(rule, 0.2);
  EXPECT_FALSE(rule.away());
}

TEST(LatenessRule, KeepsItAwayAfterTheThirdStallWithinThirtySeconds) {
  for (double apart_s : {14.0, 16.0}) {
    LatenessRule rule;
    for (int stall = 0; stall < 3; ++stall) {
      EXPECT_FALSE(rule.kept());
      rule.tick(25 * kMs, false, kT);
      calm(rule, apart_s);
    }
    EXPECT_EQ(rule.kept(), apart_s < 15.0);
    EXPECT_EQ(rule.away(), rule.kept());
    rule.clear();
    EXPECT_FALSE(rule.away());
    rule.tick(25 * kMs, false, kT);
    EXPECT_FALSE(rule.kept()) << "counted from the button on";
  }
}

TEST(LatenessRule, KeepsItAwayAfterOneStallOfOverTwoSeconds) {
  LatenessRule rule;
  rule.tick(2000 * kMs, false, kT);
  EXPECT_FALSE(rule.kept());
  rule.clear();
  rule.tick(2000 * kMs + 1, false, kT);
  EXPECT_TRUE(rule.kept());
  calm(rule, 40.0);
  EXPECT_TRUE(rule.away());
}

TEST(LatenessRule, TakesTheWatchdogsWordForAStallAndCountsItOnce) {
  LatenessRule rule;
  rule.tick(0, true, kT);
  EXPECT_TRUE(rule.away());
  calm(rule, 1.1);
  EXPECT_FALSE(rule.away());
  rule.tick(25 * kMs, true, kT);
  EXPECT_FALSE(rule.kept()) << "the second, though late as well";
  rule.tick(0, true, kT);
  EXPECT_TRUE(rule.kept());
}

TEST(OutputLimiter, ComesBackOverTwoTenthsOfASecond) {
  OutputLimiter limiter;
  for (int i = 0; i < 200; ++i) limiter.limit({2, 0, 0}, true, true, 0, kT);
  limiter.limit({2, 0, 0}, true, false, 0, kT);
  limiter.rampIn();
  for (int i = 0; i < 100; ++i) limiter.limit({2, 0, 0}, true, true, 0, kT);
  EXPECT_NEAR(limiter.sent_N().x, 1.0, 0.02);
  for (int i = 0; i < 100; ++i) limiter.limit({2, 0, 0}, true, true, 0, kT);
  EXPECT_EQ(limiter.sent_N().x, 2.0);
}

}  // namespace
}  // namespace trephine
