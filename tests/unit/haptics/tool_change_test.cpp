// An arm that is given another of its tools: only out of tissue, and nothing jumps.
#include <algorithm>
#include <cmath>
#include <random>

#include "base/rt/alloc_guard.h"
#include "haptics/unseen_energy.h"
#include "held_arm.h"

namespace trephine {
namespace {

using test::burrOnBone;
using test::Held;
using test::kOmniStep_m;

Command tool(int number, int arm = 0) {
  return {CommandKind::tool, number, {}, arm};
}

Tool drivenBurr(double radius_mm, double motor_W = 4.0) {
  return *makeTool({ToolKind::burr, 30.0, 32, radius_mm, 8, BurrShape::sphere, 0.0, motor_W});
}

// Burrs of 6 and 8 mm that do not cut, and a needle.
HapticParameters threeTools() {
  HapticParameters p = burrOnBone();
  p.arms[0].other_tools = {makeBurr(0.004, 32, 8, 0.03), makeNeedle(0.05)};
  return p;
}

// Driven burrs of 4 and 6 mm in bone that can be cut.
HapticParameters twoBurrs() {
  HapticParameters p = burrOnBone();
  p.arms[0].tool = drivenBurr(2.0);
  p.arms[0].other_tools = {drivenBurr(3.0)};
  p.tissues.classes[0].cuttable = 1;
  return p;
}

std::size_t inHand(const Held& arm) {
  return arm.bench.core.toolInHand(0);
}
bool waits(const Held& arm) {
  return (arm.now().tool_state & kToolToCome) != 0;
}

TEST(ToolChange, InAirComesAtOnceAndIsAnEvent) {
  Held arm(threeTools());
  arm.go({0, 0, 8}, 300);
  arm.tick({tool(2)});
  EXPECT_EQ(inHand(arm), 2u);
  EXPECT_FALSE(waits(arm));
  const std::vector<Event>& events = arm.bench.core.events();
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[1].kind, EventKind::tool_changed);
  EXPECT_EQ(events[1].arm, 0);
  EXPECT_EQ(events[1].value, 2u);
  EXPECT_LT(glm::distance(arm.now().proxy_position_mm, arm.now().patient_position_mm), 1e-9);
}

TEST(ToolChange, InTissueWaitsUntilTheToolIsOutAndSaysSo) {
  Held arm(threeTools());
  arm.go({0, 0, -4}, 1500);
  arm.tick({tool(1)});
  for (int n = 0; n < 500; ++n) {
    arm.tick();
    ASSERT_EQ(inHand(arm), 0u);
    EXPECT_TRUE(waits(arm));
    EXPECT_GT(glm::length(arm.now().sent_N), 1.5) << "the tool in hand is felt as before";
  }
  const double before_N = glm::length(arm.go({0, 0, 0.5}, 500).sent_N);
  EXPECT_LT(before_N, 1.5);
  arm.go({0, 0, 8}, 500);
  EXPECT_EQ(inHand(arm), 1u);
  EXPECT_FALSE(waits(arm));
}

TEST(ToolChange, TheWishIsTakenBackByTheToolInHand) {
  Held arm(threeTools());
  arm.go({0, 0, -4}, 1500);
  arm.tick({tool(1)});
  EXPECT_TRUE(waits(arm));
  arm.tick({tool(0)});
  EXPECT_FALSE(waits(arm));
  arm.go({0, 0, 8}, 500);
  EXPECT_EQ(inHand(arm), 0u);
}

// In a pit of 8 x 8 mm a burr of 4 mm has room and one of 12 mm has not.
TEST(ToolChange, WaitsWhereTheOtherToolWouldTouch) {
  Volume pit = test::boneSlab();
  for (int k = 8; k < 16; ++k) {
    for (int j = 12; j < 20; ++j) {
      for (int i = 12; i < 20; ++i) pit.hu[pit.geometry.indexOf(i, j, k)] = kAirHu;
    }
  }
  HapticParameters p = burrOnBone();
  p.arms[0].tool = makeBurr(0.002, 32, 8, 0.03);
  p.arms[0].other_tools = {makeBurr(0.006, 64, 8, 0.03)};
  test::Bench bench(p, pit);
  for (int n = 0; n < 1000; ++n) bench.at({-0.5, -0.5, 5.0 - 0.01 * n});
  ASSERT_EQ(bench.record.arms[0].tissue_class, -1);
  for (int n = 0; n < 100; ++n) bench.at({-0.5, -0.5, -5.0}, {tool(1)});
  EXPECT_EQ(bench.core.toolInHand(0), 0u);
  EXPECT_TRUE(bench.record.arms[0].tool_state & kToolToCome);
  EXPECT_EQ(bench.record.arms[0].sent_N, Vec3(0.0));
  for (int n = 0; n < 1000; ++n) bench.at({-0.5, -0.5, -5.0 + 0.01 * n});
  EXPECT_EQ(bench.core.toolInHand(0), 1u);
}

TEST(ToolChange, TheForceGoesOnFromNothingAndRisesSlowly) {
  Held arm(threeTools());
  arm.go({0, 0, -4}, 1500);
  arm.tick({tool(1)});
  Vec3 before_N = arm.now().sent_N;
  int since = -1;
  double most_N = 0.0, credit_J = 0.0;
  for (int n = 0; n < 3000; ++n) {
    // Out as a hand goes, and pressed anew.
    arm.rest_mm.z = n < 400 ? -4.0 + 0.03 * n : std::max(-4.0, 8.0 - 0.3 * (n - 400));
    arm.tick();
    const Vec3 now_N = arm.now().sent_N;
    if (inHand(arm) == 1 && since < 0) {
      since = 0;
      EXPECT_LE(glm::length(before_N), 0.05 + 1e-9);
      EXPECT_LE(glm::length(now_N), 0.05 + 1e-9);
      EXPECT_GT(credit_J, 0.0);
      EXPECT_EQ(arm.now().credit_J, 0.0) << "the controller begins anew";
    }
    if (since >= 0) {
      EXPECT_LE(glm::length(now_N) - glm::length(before_N), 0.05 + 1e-9) << since << " ms later";
      most_N = std::max(most_N, glm::length(now_N));
      if (++since == 500) break;
    }
    before_N = now_N;
    credit_J = arm.now().credit_J;
  }
  EXPECT_EQ(since, 500);
  EXPECT_GT(most_N, 1.0) << "the other tool is felt";
}

// Soft tissue pushes on a needle's sphere a little before the needle touches it.
TEST(ToolChange, AForceInAirIsWaitedForToo) {
  Volume wall = test::boneSlab();
  for (std::size_t n = 0; n < wall.hu.size(); ++n) {
    wall.hu[n] = wall.geometry.indicesOf(n)[0] >= 16 ? test::kBoneHu : kAirHu;
  }
  HapticParameters p = threeTools();
  p.arms[0].tool = makeNeedle(0.05);
  p.arms[0].other_tools = {makeNeedle(0.04)};
  p.tissues = test::boneTable(4.0, 800.0, 0.35);
  test::Bench bench(p, wall);
  for (int n = 0; n < 1000; ++n) bench.at({-4.7 + 0.003 * n, 0, 0});
  ASSERT_EQ(bench.record.arms[0].tissue_class, -1);
  ASSERT_GT(glm::length(bench.record.arms[0].sent_N), 0.1);
  for (int n = 0; n < 100; ++n) bench.at({-1.7, 0, 0}, {tool(1)});
  EXPECT_EQ(bench.core.toolInHand(0), 0u);
  for (int n = 0; n < 1000; ++n) {
    const double before_N = glm::length(bench.record.arms[0].sent_N);
    bench.at({-1.7 - 0.001 * n, 0, 0});
    for (const Event& event : bench.core.events()) {
      if (event.kind == EventKind::tool_changed) {
        EXPECT_LE(before_N, 0.05 + 1e-9);
      }
    }
  }
  EXPECT_EQ(bench.core.toolInHand(0), 1u);
}

// The encoder hides about 0.1 mJ of each contact, with or without a change.
TEST(ToolChange, GivesOutNoEnergyHoweverOftenToolsChange) {
  Held arm(threeTools());
  const double bound_J = 2.0 * unseenEnergy_J(kOmniStep_m);
  for (int cycle = 0; cycle < 9; ++cycle) {
    const double before_J = arm.energy_J();
    arm.most_J = before_J;
    arm.go({0, 0, -4}, 800);
    EXPECT_GT(glm::length(arm.now().sent_N), 1.0) << cycle;
    arm.tick({tool((cycle + 1) % 3)});
    arm.go({0, 0, 8}, 600);
    EXPECT_EQ(inHand(arm), std::size_t((cycle + 1) % 3));
    EXPECT_LT(arm.most_J, before_J + bound_J) << "cycle " << cycle;
    EXPECT_LT(arm.energy_J(), bound_J) << "nothing of it adds up";
  }
}

TEST(ToolChange, TheOtherBurrCutsAnotherHole) {
  std::array<std::uint64_t, 2> removed{};
  for (int number = 0; number < 2; ++number) {
    Held arm(twoBurrs());
    arm.go({0, 0, 8}, 300);
    arm.tick({tool(number)});
    arm.go({0, 0, -6}, 3000);
    removed[std::size_t(number)] = arm.bench.core.journal().removed(0, 0);
  }
  EXPECT_GT(removed[0], 20u);
  EXPECT_GT(double(removed[1]), 1.4 * double(removed[0]));
}

TEST(ToolChange, NothingIsCutForWorkThatTheOtherToolDid) {
  const HapticParameters p = twoBurrs();
  Held arm(p);
  double motor_J = 0.0;
  const double u_J = p.tissues.classes[0].cutting_J_per_mm3;
  for (int cycle = 0; cycle < 4; ++cycle) {
    arm.rest_mm.z = -1.5 - cycle;
    for (int n = 0; n < 400; ++n) {
      arm.tick();
      if (arm.now().tissue_class >= 0) motor_J += 1e-3 * 4.0;
      const double cut_J = u_J * double(arm.bench.core.journal().removed(0, 0));
      ASSERT_LE(cut_J, motor_J + arm.now().hand_work_J + 1e-9);
    }
    arm.tick({tool((cycle + 1) % 2)});
    arm.rest_mm.z = 8.0;
    for (int n = 0; n < 600; ++n) {
      arm.tick();
      for (const Event& event : arm.bench.core.events()) {
        if (event.kind != EventKind::tool_changed) continue;
        EXPECT_EQ(arm.now().cutting_credit_J, 0.0) << "what was not spent is heat";
      }
    }
    ASSERT_EQ(inHand(arm), std::size_t((cycle + 1) % 2));
  }
}

TEST(ToolChange, EachToolsCutsAreStrokesOfTheirOwn) {
  Held arm(twoBurrs());
  arm.rest_mm.z = -2.0;
  for (int n = 0; n < 1200; ++n) arm.tick();
  const std::uint64_t first = arm.bench.core.journal().removed(0, 0);
  ASSERT_GT(first, 5u);
  arm.tick({tool(1)});
  arm.rest_mm.z = 4.0;  // only for a moment: shorter than what ends a stroke
  for (int n = 0; n < 1000 && inHand(arm) == 0; ++n) arm.tick();
  ASSERT_EQ(inHand(arm), 1u);
  arm.rest_mm.z = -4.0;
  for (int n = 0; n < 800; ++n) arm.tick();
  ASSERT_GT(arm.bench.core.journal().removed(0, 0), first);
  arm.tick({{CommandKind::undo, 0, {}}});
  while (!arm.bench.core.acceptsCommands()) arm.tick();
  EXPECT_EQ(arm.bench.core.journal().removed(0, 0), first);
  EXPECT_EQ(inHand(arm), 1u) << "what is in the hand is not part of the tissue";
}

TEST(ToolChange, AResetGivesTheToolThatTheArmBeganWith) {
  Held arm(twoBurrs());
  arm.go({0, 0, 8}, 300);
  arm.tick({tool(1)});
  arm.go({0, 0, -4}, 1500);
  ASSERT_GT(arm.bench.core.journal().removed(0, 0), 20u);
  arm.tick({{CommandKind::reset, 0, {}}});
  EXPECT_EQ(inHand(arm), 0u) << "at once: it has no force until it is out of the tissue";
  while (!arm.bench.core.acceptsCommands()) arm.tick();
  EXPECT_EQ(arm.bench.core.journal().removed(0, 0), 0u);
  for (int n = 0; n < 100; ++n) {
    arm.tick();
    EXPECT_EQ(arm.now().sent_N, Vec3(0.0));
    EXPECT_TRUE(arm.now().tool_state & kToolWaits);
  }
  arm.go({0, 0, 8}, 800);
  EXPECT_FALSE(arm.now().tool_state & kToolWaits);
  arm.tick({tool(1)});
  ASSERT_EQ(inHand(arm), 1u);
  arm.tick({{CommandKind::reset, 0, {}}});  // nothing is cut: there is nothing to put back
  arm.tick();
  EXPECT_EQ(inHand(arm), 0u);
}

TEST(ToolChange, InAPauseAndWithTheArmClutchedToo) {
  Held arm(threeTools());
  arm.go({0, 0, 8}, 300);
  arm.tick({{CommandKind::pause, 0, {}}});
  arm.tick({tool(1)});
  EXPECT_EQ(inHand(arm), 1u);
  arm.tick({{CommandKind::resume, 0, {}}});
  arm.tick({{CommandKind::clutch_on, 0, {}, 0}});
  arm.go({0, 0, 2}, 300);
  arm.tick({tool(2)});
  EXPECT_EQ(inHand(arm), 2u);
  EXPECT_TRUE(arm.now().tool_state & kToolClutched);
  EXPECT_EQ(arm.now().sent_N, Vec3(0.0));
}

TEST(ToolChange, WithoutABarrierItWaitsForAirAsWell) {
  HapticParameters p = test::oneArm();
  p.tissues.classes[0].cuttable = 0;
  p.arms[0].other_tools = {makeNeedle(0.02, 3)};
  test::Bench bench(p);
  bench.push({0, 0, 4}, {0, 0, -3}, 700);
  bench.at({0, 0, -3}, {tool(1)});
  bench.push({0, 0, -3}, {0, 0, -2}, 100);
  EXPECT_EQ(bench.core.toolInHand(0), 0u);
  bench.push({0, 0, -2}, {0, 0, 4}, 600);
  EXPECT_EQ(bench.core.toolInHand(0), 1u);
}

TEST(ToolChange, WhatNobodyCanMeanDoesNothing) {
  Held arm(threeTools());
  arm.go({0, 0, 8}, 300);
  for (const Command& none : {tool(3), tool(-1), tool(1, 1), tool(1, -1), tool(1 << 30)}) {
    arm.tick({none});
    EXPECT_EQ(inHand(arm), 0u);
    EXPECT_FALSE(waits(arm));
  }
}

TEST(ToolChange, AnArmHasSoManyToolsAndNoMore) {
  HapticParameters p = threeTools();
  p.arms[0].other_tools.push_back(makeNeedle(0.05));
  EXPECT_TRUE(validate(p).ok());
  p.arms[0].other_tools.push_back(makeNeedle(0.05));
  EXPECT_EQ(validate(p).error().code.str(), "TOO_MANY_TOOLS");
}

// Commands of all kinds at random ticks, a hand that goes where it likes.
TEST(ToolChange, AllocatesNothingAndEveryForceIsFiniteAndBounded) {
  HapticParameters p = twoBurrs();
  p.arms[0].other_tools = {drivenBurr(3.0), makeNeedle(0.05), makeBlade(0.016, 16)};
  p.removal = RemovalKind::work;
  Held arm(p);
  std::mt19937 random(7);
  std::array<int, 4> taken{};
  std::vector<Command> none, one(1);
  const std::uint64_t allocations = rt::guardedAllocations();
  constexpr CommandKind kOthers[] = {CommandKind::undo, CommandKind::redo, CommandKind::pause,
                                     CommandKind::resume, CommandKind::reset};
  for (int n = 0; n < 20'000; ++n) {
    if (n % 250 == 0) arm.rest_mm = {double(random() % 12), 0.0, double(random() % 16) - 6.0};
    const bool speaks = n % 50 == 0 && arm.bench.core.acceptsCommands();
    if (speaks) {
      one[0] = random() % 3 == 0 ? Command{kOthers[random() % 5], 0, {}} : tool(int(random() % 4));
    }
    // Held and bench keep vectors of commands; the tick is what must not allocate.
    TickInput input;
    input.tick = arm.bench.tick++;
    input.journal = arm.bench.core.journalState();
    const Vec3 hand_N = 1000.0 * (0.001 * arm.rest_mm - arm.at_m) - 10.0 * arm.speed_m_s;
    arm.speed_m_s += 1e-3 / 0.3 * (hand_N + arm.sent_N);
    arm.at_m += 1e-3 * arm.speed_m_s;
    input.arms[0].position_m = kOmniStep_m * glm::round(arm.at_m / kOmniStep_m);
    {
      rt::NoAllocation guard;
      arm.bench.core.tick(input, speaks ? one.data() : none.data(), speaks ? 1 : 0,
                          arm.bench.record);
    }
    arm.sent_N = arm.now().sent_N;
    ++taken[inHand(arm)];
    ASSERT_TRUE(isFinite(arm.sent_N)) << n;
    ASSERT_LE(glm::length(arm.sent_N), 3.3 + 1e-9) << n;
    ASSERT_TRUE(isFinite(arm.now().proxy_position_mm)) << n;
  }
  for (const int ticks : taken) EXPECT_GT(ticks, 500);
  EXPECT_EQ(rt::guardedAllocations(), allocations);
}

}  // namespace
}  // namespace trephine
