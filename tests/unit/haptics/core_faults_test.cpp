// What the core takes for a fault, and what it does then: numbers that are none, poses that no arm
// has, a lost device, late ticks, the watchdog.
#include <limits>

#include "device/trephine_device.h"
#include "haptics_support.h"

namespace trephine {
namespace {

using test::Bench;
using test::oneArm;

TEST(HapticCore, LatchesAFaultOnAnythingThatIsNotANumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const Vec3& bad : {Vec3(nan, 0, 0), Vec3(0, inf, 0), Vec3(0, 0, -inf)}) {
    Bench bench;
    bench.push({0, 0, 2}, {0, 0, -4}, 500);
    EXPECT_EQ(bench.at(bad).sent_N, Vec3(0.0));
    EXPECT_TRUE(bench.record.arms[0].faults & kFaultNonFinite);
    EXPECT_EQ(bench.core.nonFinite(), 1u);
    ASSERT_EQ(bench.core.events().size(), 1u);
    EXPECT_EQ(bench.core.events()[0].kind, EventKind::fault);
    EXPECT_EQ(bench.push({0, 0, -4}, {0, 0, -6}, 100), 0.0) << "stays until it is cleared";
    bench.at({0, 0, -6}, {{CommandKind::clear_faults, 0, {}}});
    EXPECT_GT(bench.push({0, 0, -6}, {0, 0, -10}, 300), 0.5);
  }
}

TEST(HapticCore, ASpeedThatIsNotANumberIsAFaultInAirToo) {
  HapticParameters p = oneArm();
  p.controller = ControllerKind::seed;
  Bench bench(p);
  bench.at({0, 0, 8});
  bench.at({-1.7e308, 0, 8});
  bench.at({1.7e308, 0, 8});  // each is a number, their difference in a tick is not
  EXPECT_TRUE(bench.record.arms[0].faults & kFaultNonFinite);
  bench.at({0, 0, 8}, {{CommandKind::clear_faults, 0, {}}});
  EXPECT_TRUE(isFinite(bench.record.arms[0].observer_J));
}

TEST(HapticCore, AFaultWhileWaitingForAirDoesNotEndTheWait) {
  Bench bench;
  bench.push({0, 0, 2}, {0, 0, -6}, 800);
  bench.at({0, 0, -6}, {{CommandKind::undo, 0, {}}});
  bench.settle();
  bench.at(Vec3(std::nan("")));
  bench.at({0, 0, -6}, {{CommandKind::clear_faults, 0, {}}});
  EXPECT_EQ(bench.push({0, 0, -6}, {0, 0, -10}, 400), 0.0);
}

TEST(HapticCore, AHugeButFiniteSpeedIsClampedOrFaulted) {
  for (double far_mm : {1e9, 1e300}) {
    HapticParameters p = oneArm();
    Bench bench(p);
    bench.at({0, 0, -5});
    bench.at({far_mm, 0, 0});
    const ArmRecord& arm = bench.at({0, 0, -5});
    EXPECT_TRUE(isFinite(arm.sent_N));
    EXPECT_LE(glm::length(arm.sent_N), 3.3);
    EXPECT_TRUE(isFinite(arm.energy_out_J));
  }
}

TEST(HapticCore, APoseThatNoArmHasIsAFaultAndMovesNothing) {
  const auto faultsAfter = [](const Vec3& position_m, const Quat& orientation) {
    Bench bench;
    bench.push({0, 0, 2}, {0, 0, -4}, 500);
    TickInput input;
    input.tick = bench.tick++;
    input.journal = bench.core.journalState();
    input.arms[0].position_m = position_m;
    input.arms[0].orientation = orientation;
    bench.core.tick(input, nullptr, 0, bench.record);
    const ArmRecord& arm = bench.record.arms[0];
    EXPECT_TRUE(isFinite(arm.patient_position_mm) && isFinite(arm.velocity_m_s));
    if (arm.faults) {
      EXPECT_EQ(arm.sent_N, Vec3(0.0));
    }
    return arm.faults;
  };
  const Vec3 inside_m(0.0, 0.0, -0.004);
  const Quat straight(1, 0, 0, 0);
  EXPECT_EQ(faultsAfter(inside_m, straight), 0u);
  EXPECT_EQ(faultsAfter(inside_m, Quat(-1, 0, 0, 0)), 0u);
  for (double far_m : {2e4, -1e9, 1e300}) {
    EXPECT_EQ(faultsAfter({0.0, far_m, 0.0}, straight), kFaultNonFinite) << far_m;
  }
  for (const Quat& none : {Quat(0, 0, 0, 0), Quat(3, 0, 0, 0), Quat(1e300, 0, 0, 1e300)}) {
    EXPECT_EQ(faultsAfter(inside_m, none), kFaultNonFinite) << none.w;
  }
}

TEST(HapticCore, ADeviceThatIsLostGetsNoForce) {
  Bench bench;
  bench.push({0, 0, 2}, {0, 0, -4}, 500);
  TickInput input;
  input.tick = bench.tick++;
  input.arms[0].position_m = {0, 0, -0.005};
  input.arms[0].flags = TREPHINE_ARM_LOST;
  bench.core.tick(input, nullptr, 0, bench.record);
  EXPECT_EQ(bench.record.arms[0].sent_N, Vec3(0.0));
  EXPECT_TRUE(bench.record.arms[0].faults & kFaultDeviceLost);
}

constexpr std::int64_t kMs = 1'000'000;

TEST(HapticCore, ATickMoreThanTwentyMillisecondsLateTakesTheForceAwayForASecond) {
  Bench bench;
  bench.push({0, 0, 2}, {0, 0, -4}, 500);
  EXPECT_GT(glm::length(bench.at({0, 0, -4.01}, {}, 4 * kMs).sent_N), 0.0);
  EXPECT_EQ(bench.at({0, 0, -4.02}, {}, 20 * kMs).faults, 0u);
  EXPECT_EQ(bench.at({0, 0, -4.03}, {}, 20 * kMs + 1).sent_N, Vec3(0.0));
  EXPECT_EQ(bench.record.arms[0].faults, std::uint32_t(kFaultLate));
  const auto removed = bench.core.journal().removed(0, 0);
  double depth_mm = 4.0, back_s = 0.0, full_s = 0.0;
  for (int i = 1; i < 1500; ++i) {
    depth_mm += 0.001;
    const double sent_N = glm::length(bench.at({0, 0, -depth_mm}).sent_N);
    if (sent_N > 0.0 && back_s == 0.0) back_s = 1e-3 * i;
    if (sent_N == glm::length(bench.record.arms[0].clamped_N) && full_s == 0.0) full_s = 1e-3 * i;
    if (i == 900) {
      EXPECT_EQ(bench.core.journal().removed(0, 0), removed) << "no cutting";
    }
  }
  EXPECT_NEAR(back_s, 1.0, 0.01);
  EXPECT_NEAR(full_s, 1.2, 0.02);
  EXPECT_EQ(bench.record.arms[0].faults, 0u);
  EXPECT_GT(bench.core.journal().removed(0, 0), removed) << "and cuts again";
}

TEST(HapticCore, TheThirdStallKeepsTheForceAwayUntilItIsAskedFor) {
  Bench bench;
  bench.push({0, 0, 2}, {0, 0, -4}, 500);
  std::uint64_t events = 0;
  for (int stall = 0; stall < 3; ++stall) {
    bench.at({0, 0, -4}, {}, 25 * kMs);
    for (const Event& event : bench.core.events()) events += event.kind == EventKind::fault;
    for (int i = 0; i < 1500; ++i) bench.at({0, 0, -4 - 0.001 * i});
  }
  EXPECT_EQ(events, 4u) << "three times late, and kept";
  EXPECT_EQ(bench.record.arms[0].faults, std::uint32_t(kFaultLate | kFaultStalled));
  EXPECT_EQ(bench.record.arms[0].sent_N, Vec3(0.0));
  bench.at({0, 0, -5.5}, {{CommandKind::clear_faults, 0, {}}});
  for (int i = 0; i < 300; ++i) bench.at({0, 0, -5.5 - 0.001 * i});
  EXPECT_EQ(bench.record.arms[0].faults, 0u);
  EXPECT_GT(glm::length(bench.record.arms[0].sent_N), 0.0);
}

TEST(HapticCore, WhatTheWatchdogDidIsAnInputOfTheTickAndIsSaid) {
  Bench bench;
  bench.push({0, 0, 2}, {0, 0, -4}, 500);
  TickInput input;
  input.tick = bench.tick++;
  input.silenced = true;
  input.arms[0].position_m = {0, 0, -0.00401};
  bench.core.tick(input, nullptr, 0, bench.record);
  EXPECT_EQ(bench.record.arms[0].sent_N, Vec3(0.0));
  EXPECT_TRUE(bench.record.arms[0].faults & kFaultLate);
  ASSERT_FALSE(bench.core.events().empty());
  EXPECT_EQ(bench.core.events()[0].kind, EventKind::silenced);
}

}  // namespace
}  // namespace trephine
