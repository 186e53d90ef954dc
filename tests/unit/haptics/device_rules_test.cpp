// What an arm's own errors and its warm motors do to its force: the rules, and the core that keeps
// them.
#include "haptics/device_rules.h"

#include <cmath>

#include "device/trephine_device.h"
#include "haptics_support.h"

namespace trephine {
namespace {

constexpr double kTick_s = 1e-3;

void pass(ErrorRule& rule, double seconds) {
  for (int i = 0; i < int(seconds / kTick_s + 0.5); ++i) rule.tick(false, kTick_s);
}

TEST(ErrorRule, AnErrorTakesTheForceAwayUntilASecondAfterIt) {
  ErrorRule rule;
  rule.tick(false, kTick_s);
  EXPECT_FALSE(rule.away());
  for (int i = 0; i < 300; ++i) {
    rule.tick(true, kTick_s);
    ASSERT_TRUE(rule.away()) << i;
  }
  pass(rule, 0.999);
  EXPECT_TRUE(rule.away());
  pass(rule, 0.002);
  EXPECT_FALSE(rule.away());
  EXPECT_FALSE(rule.kept());
}

TEST(ErrorRule, TheThirdThatBeginsWithinTenSecondsKeepsItAwayUntilAsked) {
  ErrorRule seldom, often;
  for (int error = 0; error < 3; ++error) {
    seldom.tick(true, kTick_s);
    pass(seldom, 5.1);
    often.tick(true, kTick_s);
    pass(often, error < 2 ? 4.9 : 100.0);
  }
  EXPECT_FALSE(seldom.away());
  EXPECT_TRUE(often.kept() && often.away());
  often.clear();
  often.tick(false, kTick_s);
  EXPECT_FALSE(often.away());
  // One long error is one.
  ErrorRule lasting;
  for (int i = 0; i < 20000; ++i) lasting.tick(true, kTick_s);
  pass(lasting, 1.1);
  EXPECT_FALSE(lasting.away());
}

TEST(SilenceRule, TicksThatMakeUpForLateOnesAreNoSilenceOfARealArm) {
  SilenceRule rule;
  std::int64_t now_ns = 5'000'000'000;
  EXPECT_FALSE(rule.tick(7, kTick_s, now_ns));
  // A hundred ticks in five milliseconds, which a late host makes up for.
  for (int i = 0; i < 100; ++i) ASSERT_FALSE(rule.tick(7, kTick_s, now_ns += 50'000)) << i;
  EXPECT_FALSE(rule.tick(7, kTick_s, now_ns += 9'000'000));
  EXPECT_TRUE(rule.tick(7, kTick_s, now_ns += 1'000'000)) << "15 ms by the clock";
  EXPECT_FALSE(rule.tick(8, kTick_s, now_ns += 1'000'000));
}

TEST(WarmthRule, WarmMotorsGiveHalfAfterTwoSecondsAndAllOfItAgainTwoSecondsAfter) {
  WarmthRule rule;
  const ArmDynamics arm;
  EXPECT_EQ(rule.limit_N(3.3, false, 3.3, arm, kTick_s), 3.3);
  EXPECT_FALSE(rule.limits());
  double last_N = 3.3;
  for (int i = 1; i <= 3000; ++i) {
    const double now_N = rule.limit_N(3.3, true, 3.3, arm, kTick_s);
    ASSERT_LE(last_N - now_N, 3.3 * 0.5 * kTick_s / 2.0 + 1e-12) << "never at once";
    if (i == 1000) { EXPECT_NEAR(now_N, 3.3 * 0.75, 0.01); }
    last_N = now_N;
  }
  EXPECT_NEAR(last_N, 1.65, 1e-9);
  EXPECT_TRUE(rule.limits());
  for (int i = 0; i < 2001; ++i) last_N = rule.limit_N(3.3, false, 0.0, arm, kTick_s);
  EXPECT_NEAR(last_N, 3.3, 1e-9);
}

TEST(WarmthRule, APeakForceFadesToTheContinuousOneOverSecondsAndComesBackWithRest) {
  WarmthRule rule;
  ArmDynamics arm;
  arm.continuous_force_N = 1.0;
  arm.thermal_s = 20.0;
  double sent_N = 3.3, first_s = 0.0, last_N = 3.3;
  for (int i = 1; i <= 120'000; ++i) {
    const double now_N = rule.limit_N(3.3, false, sent_N, arm, kTick_s);
    ASSERT_GE(now_N, 1.0 - 1e-12);
    ASSERT_LE(std::abs(now_N - last_N), 0.02) << "over seconds";
    if (now_N < 3.3 && first_s == 0.0) first_s = i * kTick_s;
    sent_N = std::min(3.3, now_N);
    last_N = now_N;
  }
  // h = 0.8 after tau ln(1 / (1 - 0.8 / 3.3^2)).
  EXPECT_NEAR(first_s, 20.0 * -std::log(1.0 - 0.8 / (3.3 * 3.3)), 0.01);
  EXPECT_GT(first_s, 1.0);
  EXPECT_LT(last_N, 1.1) << "held for good: what the motors bear";
  for (int i = 0; i < 20'000; ++i) last_N = rule.limit_N(3.3, false, 0.0, arm, kTick_s);
  EXPECT_EQ(last_N, 3.3) << "cooled";
  // What it bears for good is never taken away, and without a time constant nothing is.
  WarmthRule borne;
  for (int i = 0; i < 200'000; ++i) ASSERT_GE(borne.limit_N(3.3, false, 0.8, arm, kTick_s), 3.3);
  arm.thermal_s = 0.0;
  for (int i = 0; i < 10'000; ++i) ASSERT_EQ(borne.limit_N(3.3, false, 3.3, arm, kTick_s), 3.3);
}

// An arm that presses a millimetre into bone, slower and slower, and says of itself what it is
// told.
struct Pressed {
  Pressed() : bench(harmless()) {
    bench.push({0, 0, 2}, {0, 0, -4}, 500);
    for (int i = 0; i < 300; ++i) say(0);
  }
  static HapticParameters harmless() {
    HapticParameters p = test::oneArm();
    p.tissues.classes[0].cuttable = 0;
    return p;
  }
  double say(std::uint32_t flags, std::vector<Command> commands = {}) {
    TickInput input;
    input.tick = bench.tick++;
    input.journal = bench.core.journalState();
    depth_mm += 0.004;
    if (depth_mm > 10.0) depth_mm = 4.0;
    input.arms[0].position_m = Vec3(0, 0, -depth_mm / 1000.0);
    input.arms[0].flags = flags;
    bench.core.tick(input, commands.data(), commands.size(), bench.record);
    return glm::length(bench.record.arms[0].sent_N);
  }
  std::uint32_t faults() const { return bench.record.arms[0].faults; }
  test::Bench bench;
  double depth_mm = 4.0;
};

TEST(HapticCore, AnErrorOfTheArmIsNoForceWithinTheTickAndARampASecondLater) {
  Pressed arm;
  ASSERT_GT(arm.say(0), 0.5);
  EXPECT_EQ(arm.say(TREPHINE_ARM_ERROR), 0.0);
  EXPECT_EQ(arm.faults(), std::uint32_t(kFaultDevice));
  ASSERT_EQ(arm.bench.core.events().size(), 1u);
  EXPECT_EQ(arm.bench.core.events()[0].value, std::int32_t(kFaultDevice));
  for (int i = 0; i < 990; ++i) ASSERT_EQ(arm.say(0), 0.0) << i;
  double last_N = 0.0, most_N = 0.0;
  for (int i = 0; i < 500; ++i) {
    const double now_N = arm.say(0);
    ASSERT_LE(now_N - last_N, 0.05 + 1e-9);
    last_N = now_N;
    most_N = std::max(most_N, now_N);
  }
  EXPECT_GT(most_N, 0.5);
  EXPECT_EQ(arm.faults(), 0u);
}

TEST(HapticCore, ThreeErrorsOfTheArmStayUntilTheForceIsAskedFor) {
  Pressed arm;
  for (int error = 0; error < 3; ++error) {
    arm.say(TREPHINE_ARM_ERROR);
    for (int i = 0; i < 1500; ++i) arm.say(0);
  }
  EXPECT_TRUE(arm.faults() & kFaultDeviceOften);
  EXPECT_EQ(arm.say(0), 0.0);
  arm.say(0, {{CommandKind::clear_faults, 0, {}}});
  EXPECT_EQ(arm.faults(), 0u);
  double most_N = 0.0;
  for (int i = 0; i < 300; ++i) most_N = std::max(most_N, arm.say(0));
  EXPECT_GT(most_N, 0.5);
}

TEST(HapticCore, WarmMotorsAreSentHalfAndItIsRecorded) {
  HapticParameters p = Pressed::harmless();
  p.tissues.classes[0].damping_Ns_per_m = 5000.0;  // more than the arm gives
  test::Bench bench(p);
  const auto say = [&](std::uint32_t flags) {
    TickInput input;
    input.tick = bench.tick++;
    input.journal = bench.core.journalState();
    input.arms[0].position_m = Vec3(0, 0, -0.004 - 2e-6 * double(bench.tick % 4000));
    input.arms[0].flags = flags;
    bench.core.tick(input, nullptr, 0, bench.record);
    return glm::length(bench.record.arms[0].sent_N);
  };
  for (int i = 0; i < 1000; ++i) say(0);
  ASSERT_NEAR(say(0), 3.3, 1e-6);
  EXPECT_FALSE(bench.record.arms[0].tool_state & kToolArmWarm);
  for (int i = 0; i < 2100; ++i) say(TREPHINE_ARM_WARM);
  EXPECT_NEAR(say(TREPHINE_ARM_WARM), 1.65, 1e-6);
  EXPECT_TRUE(bench.record.arms[0].tool_state & kToolArmWarm);
  EXPECT_EQ(bench.record.arms[0].faults, 0u);
}

TEST(SilenceRule, AnArmThatGivesTheSameSampleForFifteenMillisecondsIsSilentUntilAnother) {
  for (const double period_s : {kTick_s, 0.5 * kTick_s}) {
    SilenceRule rule;
    EXPECT_FALSE(rule.tick(7, period_s));
    const int ticks = int(0.015 / period_s + 0.5);
    for (int i = 1; i < ticks; ++i) ASSERT_FALSE(rule.tick(7, period_s)) << i;
    EXPECT_TRUE(rule.tick(7, period_s));
    EXPECT_TRUE(rule.tick(7, period_s));
    EXPECT_FALSE(rule.tick(8, period_s));
  }
}

TEST(HandRule, AHandIsKnownByAButtonAMotionOrATurn) {
  const Pose at{Vec3(0.01, 0.02, 0.03), Quat(1, 0, 0, 0)};
  const auto turned = [&](double degrees) {
    return Pose{at.position, glm::angleAxis(degrees * 3.14159265 / 180.0, Vec3(0, 1, 0))};
  };
  HandRule rests, moves, turns, presses;
  for (int i = 0; i < 1000; ++i) {
    Pose trembles = at;
    trembles.position.x += 0.004 * (i % 2);
    ASSERT_FALSE(rests.tick(trembles, false, false)) << i;
  }
  moves.tick(at, false, false);
  Pose moved = at;
  moved.position.y += 0.006;
  EXPECT_TRUE(moves.tick(moved, false, false));
  EXPECT_TRUE(moves.tick(at, false, false)) << "from then on";
  turns.tick(at, false, false);
  EXPECT_FALSE(turns.tick(turned(4.0), false, false));
  EXPECT_TRUE(turns.tick(turned(6.0), false, false));
  EXPECT_TRUE(presses.tick(at, true, false));
  EXPECT_TRUE(presses.tick(at, false, false));
}

TEST(HandRule, AnArmThatWasLostHasToBeTakenAgain) {
  const Pose at{Vec3(0.0), Quat(1, 0, 0, 0)};
  HandRule rule;
  ASSERT_TRUE(rule.tick(at, true, false));
  EXPECT_FALSE(rule.tick(at, false, true));
  EXPECT_FALSE(rule.tick(at, false, false));
  EXPECT_TRUE(rule.tick(at, true, false));
}

TEST(HapticCore, AnArmThatNobodyHoldsHasNoForceAndGetsItByTheRamp) {
  Pressed arm;
  double before_N = 0.0;
  for (int i = 0; i < 300; ++i) before_N = arm.say(0);
  ASSERT_GT(before_N, 0.5);
  EXPECT_EQ(arm.say(TREPHINE_ARM_NO_HAND), 0.0);
  EXPECT_TRUE(arm.bench.record.arms[0].tool_state & kToolNoHand);
  EXPECT_EQ(arm.faults(), 0u) << "nothing to be asked for";
  for (int i = 0; i < 50; ++i) arm.say(TREPHINE_ARM_NO_HAND);
  EXPECT_LT(arm.say(0), 0.1 * before_N) << "not at once";
  double most_N = 0.0;
  for (int i = 0; i < 300; ++i) most_N = std::max(most_N, arm.say(0));
  EXPECT_GT(most_N, 0.5);
}

}  // namespace
}  // namespace trephine
