// An arm that is clutched and re-centred: its tool stays where it is, and nothing jumps.
#include <algorithm>
#include <cmath>

#include "haptics/unseen_energy.h"
#include "held_arm.h"

namespace trephine {
namespace {

using test::burrOnBone;
using test::Held;
using test::kOmniStep_m;

Command clutch(bool on) {
  return {on ? CommandKind::clutch_on : CommandKind::clutch_off, 0, {}, 0};
}
Command clutchOff(const Quat& rotation) {
  return {CommandKind::clutch_off, 1, {}, 0, rotation};
}
Command recentre() {
  return {CommandKind::recentre, 0, {}, 0};
}

HapticParameters needleInSoftTissue() {
  HapticParameters p = burrOnBone();
  p.arms[0].tool = makeNeedle(0.05);
  p.tissues = test::boneTable(4.0, 120.0, 0.35);
  return p;
}

TEST(Clutch, FadesTheForceWithin20MsAndLeavesTheToolWhereItIs) {
  Held arm;
  const ArmRecord pressed = arm.go({0, 0, -4}, 1500);
  ASSERT_GT(glm::length(pressed.sent_N), 1.5);
  double before_N = glm::length(pressed.sent_N);
  for (int n = 0; n < 20; ++n) {
    const ArmRecord& now = arm.tick(n == 0 ? std::vector{clutch(true)} : std::vector<Command>{});
    const double size_N = glm::length(now.sent_N);
    EXPECT_LT(size_N, before_N);
    EXPECT_NEAR(before_N - size_N, glm::length(pressed.sent_N) / 20.0, 1e-9);
    EXPECT_TRUE(now.tool_state & kToolClutched);
    before_N = size_N;
  }
  EXPECT_NEAR(before_N, 0.0, 1e-12);
  const ArmRecord away = arm.go({20, -10, 25}, 1000);
  EXPECT_EQ(away.sent_N, Vec3(0.0));
  EXPECT_LT(glm::distance(away.proxy_position_mm, pressed.proxy_position_mm), 1e-6);
  EXPECT_LT(glm::distance(away.patient_position_mm, pressed.proxy_position_mm), 1e-6);
  EXPECT_GT(1000.0 * away.device_position_m.z, 20.0) << "the arm itself moves freely";
}

TEST(Clutch, OffAgainTheToolIsWhereItWasAndTheForceComesBackSlowly) {
  Held arm;
  const ArmRecord pressed = arm.go({0, 0, -4}, 1500);
  arm.tick({clutch(true)});
  arm.go({20, -10, 25}, 1000);
  const ArmRecord off = arm.tick({clutch(false)});
  EXPECT_FALSE(off.tool_state & (kToolClutched | kToolWaits));
  EXPECT_LT(glm::distance(off.patient_position_mm, pressed.proxy_position_mm), 1e-6);
  EXPECT_LT(glm::distance(off.proxy_position_mm, pressed.proxy_position_mm), 1e-3);
  double before_N = glm::length(off.sent_N), steepest_N = before_N;
  for (int n = 0; n < 1500; ++n) {
    arm.rest_mm.z = 25.0 - 5.0 * std::min(1.0, n / 100.0);  // pressed anew, and hard
    const double size_N = glm::length(arm.tick().sent_N);
    if (n < 500) steepest_N = std::max(steepest_N, size_N - before_N);
    before_N = size_N;
  }
  EXPECT_LE(steepest_N, 0.05 + 1e-9);
  EXPECT_GT(before_N, 1.0);
  EXPECT_NEAR(arm.now().proxy_position_mm.z, pressed.proxy_position_mm.z, 0.1)
      << "the same bone at the same place";
}

TEST(Clutch, GivesOutNoEnergyHoweverOftenAnArmThatPressesIsClutched) {
  Held arm;
  arm.go({0, 0, -4}, 1500);
  const double bound_J = unseenEnergy_J(kOmniStep_m);
  for (int cycle = 0; cycle < 8; ++cycle) {
    const double before_J = arm.energy_J();
    double most_J = before_J;
    const auto watch = [&](int ticks) {
      for (int n = 0; n < ticks; ++n) {
        arm.tick();
        most_J = std::max(most_J, arm.energy_J());
      }
    };
    arm.tick({clutch(true)});
    watch(300);
    arm.rest_mm.z = 1000.0 * arm.at_m.z;
    watch(200);
    arm.tick({clutch(false)});
    watch(500);
    EXPECT_LT(most_J, before_J + bound_J) << "cycle " << cycle;
    arm.go(arm.rest_mm - Vec3(0, 0, 4), 800);  // pressed again
    EXPECT_GT(glm::length(arm.now().sent_N), 1.0);
  }
  EXPECT_LT(arm.most_J, bound_J);
}

TEST(Clutch, OffWithARotationTurnsTheMotionOfTheHand) {
  Held arm;
  arm.go({0, 0, 8}, 300);
  arm.tick({clutch(true)});
  arm.go({10, 0, 8}, 300);
  const Vec3 stayed_mm = arm.now().proxy_position_mm;
  arm.tick({clutchOff(glm::angleAxis(std::acos(0.0), Vec3(0, 0, 1)))});
  EXPECT_LT(glm::distance(arm.now().proxy_position_mm, stayed_mm), 1e-6);
  arm.go({14, 0, 8}, 300);
  const Vec3 moved_mm = arm.now().proxy_position_mm - stayed_mm;
  EXPECT_NEAR(moved_mm.x, 0.0, 0.1);
  EXPECT_NEAR(moved_mm.y, 4.0, 0.2);
  EXPECT_FALSE(arm.now().tool_state & kToolWaits);
}

TEST(Clutch, AToolThatTheNewMapTurnsInTissueWaitsUntilItIsOut) {
  for (const double turn_rad : {0.0, 0.4}) {
    Held arm(needleInSoftTissue());
    arm.go({0, 0, -6}, 1500);
    ASSERT_GE(arm.now().tissue_class, 0);
    arm.tick({clutch(true)});
    arm.go({0, 0, 0}, 300);
    arm.tick({clutchOff(glm::angleAxis(turn_rad, Vec3(1, 0, 0)))});
    arm.tick();
    const bool waits = turn_rad > 0.0;
    EXPECT_EQ((arm.now().tool_state & kToolWaits) != 0, waits);
    const double sent_N = glm::length(arm.go({0, 0, -2}, 500).sent_N);
    EXPECT_EQ(sent_N == 0.0, waits);
    arm.go({0, 0, 12}, 1000);
    EXPECT_EQ(arm.now().tissue_class, -1);
    EXPECT_FALSE(arm.now().tool_state & kToolWaits);
  }
}

TEST(Clutch, APauseInTheFadeDoesNotBringTheForceBack) {
  Held arm;
  arm.go({0, 0, -4}, 1500);
  arm.tick({clutch(true)});
  arm.tick({{CommandKind::pause, 0, {}}});
  arm.tick({{CommandKind::resume, 0, {}}});
  for (int n = 0; n < 50; ++n) EXPECT_EQ(arm.tick().sent_N, Vec3(0.0));
}

TEST(Clutch, CutsNothingWhileItIsOn) {
  HapticParameters p = burrOnBone();
  p.arms[0].tool = *makeTool({ToolKind::burr, 30.0, 32, 3.0, 8, BurrShape::sphere, 0.0, 4.0});
  p.tissues.classes[0].cuttable = 1;
  Held arm(p);
  arm.go({0, 0, -3}, 1500);
  const std::uint64_t cut = arm.bench.core.journal().removed(0, 0);
  ASSERT_GT(cut, 0u);
  arm.tick({clutch(true)});
  const std::uint64_t at_once = arm.bench.core.journal().removed(0, 0);
  arm.go({5, 5, -6}, 1000);
  EXPECT_EQ(arm.bench.core.journal().removed(0, 0), at_once);
  arm.tick({clutch(false)});
  arm.go({5, 5, -9}, 1000);
  EXPECT_GT(arm.bench.core.journal().removed(0, 0), at_once);
}

TEST(Clutch, WhatNobodyCanMeanDoesNothing) {
  Held arm;
  arm.go({0, 0, 8}, 300);
  Command no_arm = clutch(true), other = clutch(true);
  no_arm.arm = -1;
  other.arm = 3;
  arm.tick({no_arm});
  arm.tick({other});
  EXPECT_FALSE(arm.now().tool_state & kToolClutched);
  arm.tick({clutch(false)});
  arm.tick({clutch(true)});
  arm.tick({clutchOff(Quat(2, 0, 0, 0))});
  EXPECT_EQ(arm.bench.core.parameters().arms[0].map.rotation, Quat(1, 0, 0, 0));
  arm.tick({clutch(true)});
  arm.tick({clutchOff(Quat(NAN, 0, 0, 0))});
  EXPECT_FALSE(arm.now().tool_state & kToolClutched);
  EXPECT_EQ(arm.now().faults, 0u);
}

TEST(Recentre, PutsTheToolWhereTheExerciseStartsItWithTheArmWhereItIs) {
  HapticParameters p = burrOnBone();
  p.arms[0].map.centre_mm = Vec3(0, 0, 6);
  Held arm(p);
  arm.go({8, -6, 4}, 500);
  arm.tick({clutch(true)});
  arm.tick({clutchOff(glm::angleAxis(0.5, Vec3(0, 1, 0)))});
  arm.tick({recentre()});
  EXPECT_LT(glm::distance(arm.now().patient_position_mm, Vec3(0, 0, 6)), 0.1);
  EXPECT_EQ(arm.now().patient_orientation, Quat(1, 0, 0, 0)) << "the map turned back";
  EXPECT_EQ(arm.now().proxy_position_mm, arm.now().patient_position_mm);
  arm.tick();
  EXPECT_FALSE(arm.now().tool_state & kToolWaits) << "it is in air there";
}

TEST(Recentre, OfAHandThatGoesBackByItselfTheMapIsTheExercisesAgain) {
  HapticParameters p = burrOnBone();
  p.arms[0].map.centre_mm = Vec3(0, 0, 6);
  Held arm(p);
  arm.go({8, -6, 4}, 500);
  arm.tick({clutch(true)});
  arm.go({2, 3, 9}, 500);
  arm.tick({clutchOff(glm::angleAxis(0.5, Vec3(0, 1, 0)))});
  ASSERT_NE(arm.bench.core.parameters().arms[0].map.centre_mm, Vec3(0, 0, 6));
  arm.tick({{CommandKind::recentre, 1, {}, 0}});
  EXPECT_EQ(arm.bench.core.parameters().arms[0].map.centre_mm, Vec3(0, 0, 6));
  EXPECT_EQ(arm.bench.core.parameters().arms[0].map.rotation, Quat(1, 0, 0, 0));
  EXPECT_EQ(arm.now().proxy_position_mm, arm.now().patient_position_mm);
}

TEST(Recentre, AToolThatComesIntoTissueWaitsThere) {
  HapticParameters p = burrOnBone();
  p.arms[0].map.centre_mm = Vec3(0, 0, -4);
  Held arm(p);
  arm.rest_mm = {0, 0, 12};
  arm.at_m = {0, 0, 0.012};
  arm.go({6, 0, 14}, 500);
  ASSERT_FALSE(arm.now().tool_state & kToolWaits);
  arm.tick({recentre()});
  for (int n = 0; n < 100; ++n) {
    EXPECT_EQ(arm.tick().sent_N, Vec3(0.0));
    EXPECT_TRUE(arm.now().tool_state & kToolWaits);
  }
  arm.go({6, 0, 24}, 500);
  EXPECT_FALSE(arm.now().tool_state & kToolWaits);
}

}  // namespace
}  // namespace trephine
