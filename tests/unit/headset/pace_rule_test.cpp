// When a picture for two eyes comes too slowly to look around with.
#include "headset/pace_rule.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

constexpr double kFrame_s = 1.0 / 90.0;

// So many seconds of a headset of 90 Hz with a new pair in one frame of `every`. When it got too
// slow; negative: never.
double run(PaceRule& rule, double& now_s, double seconds, int every) {
  for (int i = 0; i < int(seconds / kFrame_s + 0.5); ++i) {
    now_s += kFrame_s;
    rule.frame(now_s, i % every == 0);
    if (rule.tooSlow()) return double(i) * kFrame_s;
  }
  return -1.0;
}

TEST(PaceRule, FortyFiveNewPairsASecondAreEnough) {
  PaceRule rule;
  double now_s = 1000.0;
  EXPECT_LT(run(rule, now_s, 30.0, 2), 0.0);
  EXPECT_NEAR(rule.pairs_hz(), 45.0, 0.6);
}

TEST(PaceRule, FewerForTwoSecondsAreTooSlow) {
  PaceRule rule;
  double now_s = 1000.0;
  EXPECT_LT(run(rule, now_s, 5.0, 1), 0.0);
  const double after_s = run(rule, now_s, 5.0, 3);
  EXPECT_GT(after_s, 0.5);
  EXPECT_LE(after_s, 2.0);
  EXPECT_LT(rule.pairs_hz(), 45.0);
  // One that is slow from the start is given two seconds.
  PaceRule slow;
  EXPECT_NEAR(run(slow, now_s, 5.0, 90), 2.0, 0.05);
}

TEST(PaceRule, AShortStutterIsNone) {
  PaceRule rule;
  double now_s = 0.0;
  EXPECT_LT(run(rule, now_s, 5.0, 1), 0.0);
  EXPECT_LT(run(rule, now_s, 0.9, 1000), 0.0);
  EXPECT_LT(run(rule, now_s, 5.0, 1), 0.0);
}

TEST(PaceRule, ItComesBackOncePairsThatAreTriedAreFastInARow) {
  PaceRule rule;
  double now_s = 0.0;
  run(rule, now_s, 5.0, 30);
  ASSERT_TRUE(rule.tooSlow());
  for (const double ms : {10.0, 10.0, 40.0, 10.0, 10.0}) rule.tried(1e-3 * ms);
  EXPECT_TRUE(rule.tooSlow());
  rule.tried(10e-3);
  EXPECT_FALSE(rule.tooSlow());
  EXPECT_NEAR(run(rule, now_s, 5.0, 30), 2.0, 0.05) << "and is given two seconds again";
}

TEST(PaceRule, WithoutALimitNothingIsTooSlow) {
  PaceLimits limits;
  limits.least_hz = 0.0;
  PaceRule rule(limits);
  double now_s = 0.0;
  EXPECT_LT(run(rule, now_s, 20.0, 1000), 0.0);
}

TEST(PaceRule, AHeadsetThatWasTakenOffIsJudgedAnew) {
  PaceRule rule;
  double now_s = 1000.0;
  EXPECT_LT(run(rule, now_s, 5.0, 1), 0.0);
  rule.pause();
  now_s += 3.0;
  EXPECT_LT(run(rule, now_s, 5.0, 1), 0.0);
  EXPECT_NEAR(rule.pairs_hz(), 90.0, 1.0);
}

}  // namespace
}  // namespace trephine
