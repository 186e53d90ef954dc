#include "haptics/haptic_core.h"

#include "base/rt/alloc_guard.h"
#include "haptics_support.h"

namespace trephine {
namespace {

using test::Bench;
using test::boneSlab;
using test::oneArm;

std::string hashOf(const Grid& grid) { return volumeSha256(grid.snapshot()); }

TEST(HapticCore, SendsNoForceInAir) {
  Bench bench;
  EXPECT_EQ(bench.push({0, 0, 8}, {3, 0, 3}, 200), 0.0);
  EXPECT_EQ(bench.record.arms[0].tissue_class, -1);
}

TEST(HapticCore, BoneResistsTheToolAndIsRemovedByIt) {
  Bench bench;
  const double force = bench.push({0, 0, 2}, {0, 0, -6}, 800);
  EXPECT_GT(force, 1.5);
  EXPECT_LE(force, 3.3);
  EXPECT_EQ(bench.core.journal().removed(0, 0), 6u);  // a needle takes the voxels on its way
  EXPECT_GT(bench.record.arms[0].sent_N.z, 0.0) << "pushes back, out of the bone";
}

TEST(HapticCore, RemovesOnlyWhatMayBeCut) {
  HapticParameters p = oneArm();
  p.tissues.classes[0].cuttable = 0;
  Bench bench(p);
  const std::string before = hashOf(bench.grid);
  EXPECT_GT(bench.push({0, 0, 2}, {0, 0, -6}, 800), 1.5);
  EXPECT_EQ(hashOf(bench.grid), before);
}

// Into soft tissue, out again the same way: by the elastic law alone.
struct InAndOut {
  double in_N = 0.0, out_N = 0.0;  // the greatest push

  explicit InAndOut(bool cuts) {
    HapticParameters p = oneArm();
    p.arms[0].tool = *makeTool({.kind = ToolKind::needle, .length_mm = 60.0});
    p.laws = {LawKind::elastic};
    p.removal = RemovalKind::work;
    p.tissues.classes[0] = {{0.0, 384.0, 0.0, 0.0, cuts ? 1e-5 : 1.0}, 200, 3071, 1, 0, 0, 0};
    Bench bench(p);
    const auto push_N = [&] { return bench.record.arms[0].demanded_N.z; };
    for (double z = 8.0; z > -8.0; z -= 0.02) {
      bench.at({0.3, 0.2, z});
      in_N = std::max(in_N, push_N());
    }
    for (double z = -8.0; z < 8.0; z += 0.02) {
      bench.at({0.3, 0.2, z});
      out_N = std::max(out_N, push_N());
    }
    EXPECT_EQ(bench.core.journal().removed(0, 0) > 0, cuts);
  }
};

TEST(HapticCore, ASharpToolsPushHardlyComesBackOnTheWayOut) {
  const InAndOut whole(false), cut(true);
  EXPECT_GT(whole.in_N, 0.3);
  EXPECT_LT(whole.out_N, 1e-9) << "nothing was cut: nothing comes back";
  EXPECT_GT(cut.in_N, 0.3);
  EXPECT_LT(cut.out_N, 0.15 * cut.in_N) << "the sides of what was cut push a little";
}

TEST(HapticCore, NeverExceedsTheArmsLimit) {
  HapticParameters p = oneArm();
  p.tissues = test::boneTable(1e9, 1e9, 1e9);
  Bench bench(p);
  const double force = bench.push({0, 0, 2}, {0, 0, -6}, 100);
  EXPECT_NEAR(force, 3.3, 1e-9);
}

// The hand works against no force in a pause: nothing of that says anything of the arm.
TEST(HapticCore, TheBoundedControllerLearnsNothingWhileItsForceIsNotSent) {
  HapticParameters p = oneArm();
  p.controller = ControllerKind::bounded;
  p.arms[0].dynamics = {0.045, 5.5e-5, 3.3, 0};
  p.tissues.classes[0].cuttable = 0;
  const auto wiggle = [](Bench& bench) {
    for (int i = 0; i < 5000; ++i) {
      const double phase = std::abs(double(i % 500) / 250.0 - 1.0);
      bench.at({0, 0, -1.0 - 4.0 * phase});
    }
  };
  for (CommandKind stop : {CommandKind::pause, CommandKind::none}) {
    Bench bench(p);
    bench.push({0, 0, 2}, {0, 0, -3}, 500);
    constexpr std::int64_t kTooLong_ns = 2'500'000'000;  // takes the force away for good
    bench.at({0, 0, -3}, {{stop, 0, {}}}, stop == CommandKind::none ? kTooLong_ns : 0);
    wiggle(bench);
    EXPECT_EQ(bench.record.arms[0].sent_N, Vec3(0.0));
    EXPECT_EQ(bench.record.arms[0].learnt_scale, 1.0);
  }
}

TEST(HapticCore, TheBoundedControllerShowsTheTissueThroughAScaledAndTurnedMap) {
  HapticParameters p = oneArm();
  p.controller = ControllerKind::bounded;
  p.arms[0].dynamics = {0.045, 0.0, 3.3, 0};
  p.arms[0].map.motion_scale = 2.0;
  p.arms[0].map.force_scale = 0.5;
  p.arms[0].map.rotation = Quat(std::sqrt(0.5), std::sqrt(0.5), 0, 0);  // device y is patient z
  p.tissues = test::boneTable(5.0, 300.0, 100.0);
  p.tissues.classes[0].cuttable = 0;
  Bench bench(p);
  // The tip moves 10 mm/s in the patient, 5 mm/s at the arm.
  bench.push({0, 2, 0}, {0, -2, 0}, 800);
  const ArmRecord& record = bench.record.arms[0];
  EXPECT_NEAR(record.demanded_N.y, 0.5 * (300.0 * 4.59e-3 + 5.0 * 1e-2), 0.005);  // touches at z = 0.6
  EXPECT_NEAR(record.bounded_N.y, record.demanded_N.y, 0.02);
  EXPECT_NEAR(glm::length(record.bounded_N), record.bounded_N.y, 1e-6);
}

TEST(HapticCore, ASlowLoopKeepsTheSignOfStiffness) {
  HapticParameters p = oneArm();
  p.period_s = 0.01;
  p.controller = ControllerKind::bounded;
  p.arms[0].dynamics = {0.045, 5.5e-5, 3.3, 0};
  p.tissues = test::boneTable(0.5, 60.0, 2.0);
  p.tissues.classes[0].cuttable = 0;
  Bench bench(p);
  for (int i = 0; i <= 100; ++i) {
    const ArmRecord& record = bench.at({0, 0, 1.0 - 0.04 * i});
    EXPECT_EQ(record.controller_parts & kPartArmBound, 0u) << i;
    if (i > 60) {
      EXPECT_NEAR(record.bounded_N.z, record.demanded_N.z, 0.02) << i;
    }
  }
}

TEST(HapticCore, UndoPutsTheStrokeBackAndRedoTakesItAgain) {
  Bench bench;
  const std::string whole = hashOf(bench.grid);
  bench.push({0, 0, 2}, {0, 0, -6}, 800);
  const std::string cut = hashOf(bench.grid);
  ASSERT_NE(cut, whole);
  bench.at({0, 0, 10}, {{CommandKind::undo, 0, {}}});
  bench.settle();
  EXPECT_EQ(hashOf(bench.grid), whole);
  EXPECT_EQ(bench.core.journal().removed(0, 0), 0u);
  bench.at({0, 0, 10}, {{CommandKind::redo, 0, {}}});
  bench.settle();
  EXPECT_EQ(hashOf(bench.grid), cut);
  EXPECT_EQ(bench.core.journal().removed(0, 0), 6u);
}

TEST(HapticCore, LeavingTheTissueEndsAStroke) {
  Bench bench;
  bench.push({0, 0, 2}, {0, 0, -3}, 300);
  const std::string first = hashOf(bench.grid);
  bench.push({5, 0, 5}, {5, 0, 5}, 400);
  bench.push({5, 0, 2}, {5, 0, -3}, 300);
  bench.at({5, 0, 8}, {{CommandKind::undo, 0, {}}});
  bench.settle();
  EXPECT_EQ(hashOf(bench.grid), first);
}

TEST(HapticCore, RestingInTheTissueDoesNotEndAStroke) {
  Bench bench;
  const std::string whole = hashOf(bench.grid);
  bench.push({0, 0, 2}, {0, 0, -3}, 300);
  bench.push({0, 0, -3}, {0, 0, -3}, 1000);
  bench.push({0, 0, -3}, {0, 0, -6}, 300);
  bench.at({0, 0, 10}, {{CommandKind::undo, 0, {}}});
  bench.settle();
  EXPECT_EQ(hashOf(bench.grid), whole);
}

TEST(HapticCore, ResetRestoresEverythingInSlicesAndThenAcceptsCommands) {
  HapticParameters p = oneArm();
  p.arms[0].tool = makeBlade(0.014, 29);
  Bench bench(p);
  const std::string whole = hashOf(bench.grid);
  for (double y = -12; y < 12; y += 1.0) bench.push({-14, y, -14}, {14, y, -14}, 60);
  ASSERT_GT(bench.core.journal().removed(0, 0), 3000u);
  bench.at({0, 0, 15}, {{CommandKind::reset, 0, {}}});
  EXPECT_FALSE(bench.core.acceptsCommands()) << "more voxels than one tick restores";
  for (int i = 0; i < 20 && !bench.core.acceptsCommands(); ++i) bench.at({0, 0, 15});
  EXPECT_TRUE(bench.core.acceptsCommands());
  EXPECT_EQ(hashOf(bench.grid), whole);
}

TEST(HapticCore, SendsNoForceAfterUndoUntilTheToolLeftTheTissue) {
  Bench bench;
  bench.push({0, 0, 2}, {0, 0, -6}, 800);
  bench.at({0, 0, -6}, {{CommandKind::undo, 0, {}}});
  bench.settle();
  EXPECT_EQ(bench.push({0, 0, -6}, {0, 0, -10}, 400), 0.0);
  bench.push({0, 0, -10}, {0, 0, 5}, 400);
  EXPECT_GT(bench.push({3, 0, 2}, {3, 0, -4}, 600), 0.5);
}

TEST(HapticCore, CutsNothingAfterUndoUntilTheToolLeftTheTissue) {
  Bench bench;
  const std::string whole = hashOf(bench.grid);
  bench.push({0, 0, 2}, {0, 0, -6}, 800);
  bench.at({0, 0, -6}, {{CommandKind::undo, 0, {}}});
  bench.settle();
  bench.push({0, 0, -6}, {3, 0, -9}, 400);
  EXPECT_EQ(hashOf(bench.grid), whole);
  bench.push({3, 0, -9}, {3, 0, 5}, 400);
  bench.push({3, 0, 2}, {3, 0, -4}, 600);
  EXPECT_NE(hashOf(bench.grid), whole);
}

TEST(HapticCore, NoChangeRaisesTheForceFasterThanTheSlewLimit) {
  const double step = kSlew_N_per_s * 0.001 + 1e-12;
  TissueTable hard = test::boneTable(200.0, 5000.0, 50.0);
  ASSERT_EQ(hard.count, 1);
  const std::vector<Command> changes{{CommandKind::controller, 1, {}},
                                     {CommandKind::tissues, 0, &hard},
                                     {CommandKind::clear_faults, 0, {}},
                                     {CommandKind::resume, 0, {}}};
  for (const Command& change : changes) {
    Bench bench;
    bench.push({0, 0, 2}, {0, 0, -4}, 600);
    double last = glm::length(bench.record.arms[0].sent_N);
    for (int i = 0; i < 30; ++i) {
      const ArmRecord& arm = bench.at({0.02 * i, 0, -4 - 0.01 * i}, i == 0 ? std::vector{change}
                                                                            : std::vector<Command>{});
      ASSERT_LE(glm::length(arm.sent_N) - last, step) << "command " << int(change.kind);
      last = glm::length(arm.sent_N);
    }
  }
}

TEST(HapticCore, StartsSlowlyWhenTheToolStandsInTissue) {
  HapticParameters p = oneArm();
  p.tissues = test::boneTable(1000.0, 0.0, 0.0);
  Bench bench(p);
  bench.at({0, 0, -5});
  const ArmRecord& arm = bench.at({0, 0, -5.1});
  EXPECT_GT(glm::length(arm.clamped_N), 3.0);
  EXPECT_LE(glm::length(arm.sent_N), 0.05 + 1e-12);
}

TEST(HapticCore, PauseStopsForceAndRemoval) {
  Bench bench;
  bench.push({0, 0, 2}, {0, 0, -3}, 500);
  const auto removed = bench.core.journal().removed(0, 0);
  bench.at({0, 0, -3}, {{CommandKind::pause, 0, {}}});
  EXPECT_EQ(bench.push({0, 0, -3}, {0, 0, -8}, 500), 0.0);
  EXPECT_EQ(bench.core.journal().removed(0, 0), removed);
}

TEST(HapticCore, TheSecondsOfAnExerciseStandStillInAPause) {
  Bench bench;
  bench.push({0, 0, 8}, {0, 0, 7}, 2499);
  EXPECT_EQ(bench.core.journal().seconds(), 2u);
  bench.at({0, 0, 7}, {{CommandKind::pause, 0, {}}});
  bench.push({0, 0, 7}, {0, 0, 8}, 5000);
  EXPECT_EQ(bench.core.journal().seconds(), 2u);
  bench.at({0, 0, 8}, {{CommandKind::resume, 0, {}}});
  bench.push({0, 0, 8}, {0, 0, 7}, 450);
  EXPECT_EQ(bench.core.journal().seconds(), 2u);
  bench.push({0, 0, 7}, {0, 0, 8}, 100);
  EXPECT_EQ(bench.core.journal().seconds(), 3u) << "half a second before the pause, half after it";
}

// Removal's pass, the slew limit's state and the counts of empty bricks belong to voxels and force.
TEST(HapticCore, ATissueEditThatMovesNoVoxelChangesNothingThatIsCut) {
  std::array<std::uint64_t, 2> removed{};
  for (int edited = 0; edited < 2; ++edited) {
    HapticParameters p = oneArm();
    p.arms[0].tool = *makeTool({ToolKind::burr, 30.0, 64, 3.0, 8, BurrShape::sphere, 0.0, 3.0});
    p.removal = RemovalKind::work;
    Bench bench(p);
    for (int i = 0; i < 3000; ++i) {
      std::vector<Command> commands;
      TissueTable same_voxels = p.tissues;
      if (edited && i % 20 == 0) {
        same_voxels.classes[0].rupture_N = i;  // no law of this exercise reads it
        commands.push_back({CommandKind::tissues, 0, &same_voxels});
      }
      bench.at({0.001 * i, 0, 1 - 0.002 * i}, commands);
    }
    removed[std::size_t(edited)] = bench.core.journal().removed(0, 0);
  }
  EXPECT_GT(removed[0], 20u);
  EXPECT_EQ(removed[0], removed[1]);
}

TEST(HapticCore, AFullJournalStopsRemovalAndSaysSo) {
  HapticParameters p = oneArm();
  p.arms[0].tool = makeBurr(0.005, 64, 0, 0.03);
  p.journal_voxels = 600;
  Bench bench(p);
  bool said = false;
  for (int i = 0; i < 1200; ++i) {
    bench.at({0, 0, 2 - 0.01 * i});
    for (const Event& event : bench.core.events()) said |= event.kind == EventKind::journal_full;
  }
  EXPECT_TRUE(said);
  // It stops while there is room for one tick more.
  EXPECT_GT(bench.core.journal().removed(0, 0), 512u);
  EXPECT_LE(bench.core.journal().removed(0, 0), 1024u);
}

TEST(HapticCore, EnergyIsTheWorkOfTheHeldForceByAxis) {
  Bench bench;
  bench.push({0, 0, 2}, {0, 0, -3}, 500);
  const Vec3 held = bench.record.arms[0].sent_N;
  const Vec3 before = bench.record.arms[0].energy_out_J;
  bench.at({0.2, 0.1, -3.3});
  const Vec3 work = held * Vec3(0.2e-3, 0.1e-3, -0.3e-3);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(bench.record.arms[0].energy_out_J[axis] - before[axis], work[axis], 1e-15);
  }
}

TEST(HapticCore, TheMapScalesMotionAndForce) {
  HapticParameters p = oneArm();
  p.laws = {LawKind::viscous};
  p.arms[0].map.motion_scale = 2.0;
  p.arms[0].map.force_scale = 0.5;
  p.arms[0].map.rotation = glm::angleAxis(glm::radians(90.0), Vec3(0, 0, 1));
  Bench bench(p);
  bench.at({0, 0, -3});
  const ArmRecord& arm = bench.at({0.01, 0, -3});  // device mm; patient: 0.02 mm along +y
  EXPECT_NEAR(arm.patient_position_mm.y, 0.02, 1e-12);
  EXPECT_NEAR(arm.patient_position_mm.z, -6.0, 1e-12);
  EXPECT_NEAR(arm.velocity_m_s.y, 0.02, 1e-12);
  EXPECT_NEAR(arm.demanded_N.x, -0.5 * 10.0 * 2.0 * 0.01, 1e-12) << "g s b v";
}

TEST(HapticCore, TwoArmsShareOneVolumeAndEachStrokeIsCreditedToItsArm) {
  HapticParameters p = oneArm();
  p.arms.push_back(p.arms[0]);
  Bench bench(p);
  for (int i = 0; i < 500; ++i) {
    TickInput input;
    input.tick = bench.tick++;
    input.arms[0].position_m = Vec3(0, 0, 2 - 0.01 * i) / 1000.0;
    input.arms[1].position_m = Vec3(4, 0, 2 - 0.01 * i) / 1000.0;
    bench.core.tick(input, nullptr, 0, bench.record);
  }
  EXPECT_EQ(bench.core.journal().removed(0, 0), 3u);
  EXPECT_EQ(bench.core.journal().removed(1, 0), 3u);
}

TEST(HapticCore, TheTickAllocatesNothing) {
  HapticParameters p = oneArm();
  p.arms[0].tool = makeBlade(0.010, 100);
  Bench bench(p);
  const std::vector<Command> commands{{CommandKind::undo, 0, {}}, {CommandKind::controller, 1, {}}};
  TickInput input;
  bench.push({0, 0, 2}, {0, 0, -3}, 100);
  const std::uint64_t before = rt::guardedAllocations();
  {
    rt::NoAllocation guard;
    for (int i = 0; i < 2000; ++i) {
      input.tick = bench.tick++;
      input.arms[0].position_m = Vec3(0.005 * i - 5, 0, -0.004 * i) / 1000.0;
      const bool command = i % 500 == 400;
      bench.core.tick(input, commands.data(), command ? commands.size() : 0, bench.record);
    }
  }
  EXPECT_EQ(rt::guardedAllocations(), before);
  EXPECT_GT(bench.core.journal().entryCount(), 0u);
}

// --- By points alone: the seed paper's rule of touch ---

HapticParameters byPoints() {
  HapticParameters p = oneArm();
  p.arms[0].tool = makeBlade(0.010, 11);
  p.laws = {LawKind::viscous};
  p.touch_by_points = 1;
  return p;
}

TEST(HapticCoreByPoints, TheVoxelOfEachPointThatTouchesGoesAndUndoBringsItBack) {
  Bench bench(byPoints());
  const std::string whole = hashOf(bench.grid);
  bench.push({0.45, 0, 2}, {0.45, 0, -3.2}, 520);
  Volume expected = boneSlab();
  const GridGeometry& g = expected.geometry;
  for (int k : {13, 14, 15}) expected.hu[g.indexOf(16, 16, k)] = kAirHu;
  EXPECT_EQ(hashOf(bench.grid), volumeSha256(expected))
      << "three below each other: what the tool's solid meets beside them stays";
  // Aslant all of its points are in bone, in voxels of their own.
  TickInput input;
  input.tick = bench.tick++;
  input.arms[0].position_m = Vec3(-0.005, 0.004, -0.008);
  input.arms[0].orientation = glm::angleAxis(glm::radians(90.0), Vec3(0, 1, 0));
  bench.core.tick(input, nullptr, 0, bench.record);
  EXPECT_EQ(bench.record.arms[0].points_in_tissue, 11);
  EXPECT_EQ(bench.record.arms[0].removed_voxels, 11);
  for (int n = 0; n < 400; ++n) bench.at({0, 0, 10});
  bench.at({0, 0, 10}, {{CommandKind::undo, 0, {}}});
  bench.settle();
  EXPECT_EQ(hashOf(bench.grid), whole);
}

TEST(HapticCoreByPoints, ItsForceIsMinusBTimesV) {
  Bench bench(byPoints());
  for (int n = 0; n < 200; ++n) bench.at({0, 0, 0.5 - 0.005 * n});
  const ArmRecord& record = bench.at({0.003, 0, 0.5 - 0.005 * 199 - 0.004});
  EXPECT_EQ(record.tissue_class, -1) << "what it touched is gone";
  EXPECT_EQ(record.demanded_N, Vec3(0.0));
  bench.at({0, 0, -1.0});
  const ArmRecord& deeper = bench.at({0, 0, -1.6});
  EXPECT_EQ(deeper.points_in_tissue, 1);
  EXPECT_NEAR(deeper.demanded_N.z, 10.0 * 0.6, 1e-9);
}

TEST(HapticCoreByPoints, WhatMayNotBeCutPushesAndStays) {
  HapticParameters p = byPoints();
  p.tissues.classes[0].cuttable = 0;
  Bench bench(p);
  const std::string whole = hashOf(bench.grid);
  bench.push({0, 0, 2}, {0, 0, -6}, 800);
  EXPECT_EQ(bench.record.arms[0].points_in_tissue, 6);
  EXPECT_EQ(hashOf(bench.grid), whole);
}

TEST(HapticCoreByPoints, TheTickAllocatesNothing) {
  HapticParameters p = byPoints();
  p.arms[0].tool = makeBlade(0.010, 100);
  Bench bench(p);
  TickInput input;
  const std::uint64_t before = rt::guardedAllocations();
  {
    rt::NoAllocation guard;
    for (int i = 0; i < 2000; ++i) {
      input.tick = bench.tick++;
      input.arms[0].position_m = Vec3(0.005 * i - 5, 0, 2.0 - 0.004 * i) / 1000.0;
      bench.core.tick(input, nullptr, 0, bench.record);
    }
  }
  EXPECT_EQ(rt::guardedAllocations(), before);
  EXPECT_GT(bench.core.journal().entryCount(), 0u);
}

TEST(HapticCore, IsAPureFunctionOfItsInputs) {
  Bench a, b;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 tip(3 * std::sin(0.01 * i), 2 * std::cos(0.013 * i), 1 - 0.002 * i);
    std::vector<Command> commands;
    if (i == 1500) commands.push_back({CommandKind::undo, 0, {}});
    a.at(tip, commands);
    b.at(tip, commands);
    ASSERT_EQ(a.record.arms[0].sent_N, b.record.arms[0].sent_N);
  }
  EXPECT_EQ(hashOf(a.grid), hashOf(b.grid));
}

}  // namespace
}  // namespace trephine
