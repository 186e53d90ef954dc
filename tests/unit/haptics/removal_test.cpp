// Removal through the core: what a prescribed stroke takes, whatever the grid, the rate and the
// order of the arms.
#include "haptics/removal.h"

#include <cmath>
#include <string>

#include "haptics_support.h"

namespace trephine {
namespace {

using test::Bench;
using test::kBoneHu;

// A box of air and bone around the origin; bone below a plane that no grid axis lies in.
const Vec3 kSlope = glm::normalize(Vec3(0.12, -0.07, 1.0));

Volume slope(int voxels, double box_mm) {
  Volume volume;
  const double spacing = box_mm / voxels;
  volume.geometry.size = {voxels, voxels, voxels};
  volume.geometry.spacing_mm = Vec3(spacing);
  volume.geometry.origin_mm = Vec3(-0.5 * (voxels - 1) * spacing);
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  for (int k = 0; k < voxels; ++k) {
    for (int j = 0; j < voxels; ++j) {
      for (int i = 0; i < voxels; ++i) {
        const Vec3 p = volume.geometry.origin_mm + spacing * Vec3(i, j, k);
        if (glm::dot(p, kSlope) < 0.0) volume.hu[volume.geometry.indexOf(i, j, k)] = kBoneHu;
      }
    }
  }
  return volume;
}

struct Stroke {
  Tool tool;
  std::vector<Vec3> way_mm;  // of the tip
  double speed_mm_per_s = 10.0;
  double cutting_J_per_mm3 = 0.06;
  double turn_rad = 0.0;     // of the tool about y, leaning
  bool solid = true;
};

// Into the bone, along it and out again, by a way that turns.
Stroke burrStroke(double motor_W, double depth_mm) {
  Stroke s;
  s.tool = *makeTool({ToolKind::burr, 30.0, 64, 3.0, 8, BurrShape::sphere, 0.0, motor_W});
  s.way_mm = {{-5, -4, 3}, {-5, -4, -depth_mm}, {5, -2.5, -depth_mm - 0.4}, {4, 4.5, -depth_mm}, {4, 4.5, 4}};
  return s;
}

struct Outcome {
  double removed_mm3 = 0.0;
  std::uint64_t voxels = 0;
  Volume volume;
};

Outcome run(const Stroke& stroke, int voxels, double box_mm, double rate_hz,
            RemovalKind removal = RemovalKind::work) {
  HapticParameters p = test::oneArm();
  p.period_s = 1.0 / rate_hz;
  p.arms[0].tool = stroke.tool;
  p.laws = {LawKind::viscous, LawKind::coulomb, LawKind::elastic};
  p.removal = removal;
  p.tissues = test::boneTable(12.0, 900.0, 2.0);
  p.tissues.classes[0].cutting_J_per_mm3 = stroke.cutting_J_per_mm3;
  p.tissues.classes[0].solid = stroke.solid;
  p.journal_voxels = 4'000'000;
  Grid grid(slope(voxels, box_mm));
  HapticCore core(p, *grid.takeWriter());
  TickInput input;
  TickRecord record;
  const Quat turn(std::cos(stroke.turn_rad / 2), 0, std::sin(stroke.turn_rad / 2), 0);
  for (std::size_t leg = 0; leg + 1 < stroke.way_mm.size(); ++leg) {
    const Vec3 from = stroke.way_mm[leg], way = stroke.way_mm[leg + 1] - from;
    const int ticks = int(glm::length(way) / stroke.speed_mm_per_s * rate_hz);
    for (int n = 0; n < ticks; ++n) {
      input.arms[0].position_m = (from + way * (double(n) / ticks)) / 1000.0;
      input.arms[0].orientation = turn;
      input.journal = core.journalState();
      core.tick(input, nullptr, 0, record);
      ++input.tick;
    }
  }
  Outcome out;
  out.voxels = core.journal().removed(0, 0);
  out.removed_mm3 = double(out.voxels) * grid.geometry().voxelVolume_mm3();
  out.volume = grid.snapshot();
  return out;
}

// The same mm3 on a grid of `voxels` and of half as many, and at 500 Hz, 1 kHz and 4 kHz.
void expectSame(const Stroke& stroke, int voxels, double box_mm) {
  const double reference = run(stroke, voxels, box_mm, 1000.0).removed_mm3;
  ASSERT_GT(reference, 10.0);
  for (int n : {voxels / 2, voxels}) {
    for (double rate : {500.0, 1000.0, 4000.0}) {
      const double mm3 = run(stroke, n, box_mm, rate).removed_mm3;
      EXPECT_NEAR(mm3, reference, 0.05 * reference) << n << " voxels at " << rate << " Hz";
    }
  }
}
// 0.19 and 0.1 mm: as 256^3 and 512^3 over 49.2 mm.
void expectSameOnFineGrids(const Stroke& stroke) { expectSame(stroke, 256, 24.6); }

TEST(Removal, SpendsAgainAfterAnUndoWhatTheUndoneStrokeSpent) {
  const Grid bone(slope(16, 8.0));
  TissueTable tissues = test::boneTable(12.0, 900.0, 2.0);
  tissues.classes[0].cutting_J_per_mm3 = 0.06;
  const TissueField tissue(bone, tissues);
  Removal removal(burrStroke(0.0, 1.0).tool, bone.geometry(), RemovalKind::work, 1e-3);
  const double price_J = 0.06 * bone.geometry().voxelVolume_mm3();
  removal.giveWork(1.5 * price_J, 1.5 * price_J, tissue);
  const double before_J = removal.credit_J();
  std::vector<RemovedVoxel> removed;
  removal.take(tissue, {1, 1, 1}, 0, removed);
  removal.take(tissue, {1, 1, 2}, 0, removed);
  ASSERT_EQ(removed.size(), 1u) << "it pays for one";
  removal.setCredit(before_J);
  removal.take(tissue, {1, 1, 2}, 0, removed);
  EXPECT_EQ(removed.size(), 2u);
  // And after a redo it has spent it.
  removal.setCredit(before_J - price_J);
  removal.setCredit(before_J - price_J);
  removal.take(tissue, {1, 1, 3}, 0, removed);
  EXPECT_EQ(removed.size(), 2u);
}

TEST(Removal, AStrokeWithAStrongMotorTakesTheSameOnAnyGridAndAtAnyRate) {
  expectSameOnFineGrids(burrStroke(40.0, 1.5));
}
TEST(Removal, AStrokeThatRunsShortOfWorkTakesTheSameOnAnyGridAndAtAnyRate) {
  expectSameOnFineGrids(burrStroke(4.0, 1.5));
}
TEST(Removal, AStrokeByHandAloneTakesTheSameOnAnyGridAndAtAnyRate) {
  Stroke s = burrStroke(0.0, 2.5);
  s.tool = *makeTool({ToolKind::blade, 16.0, 64, 3.0});
  s.cutting_J_per_mm3 = 3e-4;
  s.solid = false;
  expectSameOnFineGrids(s);
}
TEST(Removal, ASlantedBladeTakesTheSameOnAnyGridAndAtAnyRate) {
  Stroke s;
  s.tool = *makeTool({ToolKind::blade, 16.0, 64, 0.6, 0, BurrShape::sphere, 0.0, 6.0});
  s.way_mm = {{-5, -4, 3}, {-5, -4, -4}, {5, -2.5, -4.5}, {5, -2.5, 4}};
  s.turn_rad = 0.5;
  expectSameOnFineGrids(s);
}

// 0.78 and 0.39 mm: as 256^3 and 512^3 over 200 mm.
TEST(Removal, AStrokeTakesTheSameOnCoarseGridsToo) {
  expectSame(burrStroke(40.0, 2.0), 128, 50.0);
  expectSame(burrStroke(4.0, 2.0), 128, 50.0);
}

double toSegment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  return glm::length(p - a - std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0, 1.0) * ab);
}

TEST(Removal, ABurrLeavesNoIslandsInsideTheSolidItSwept) {
  const Stroke stroke = burrStroke(40.0, 2.5);
  for (RemovalKind kind : {RemovalKind::work, RemovalKind::instant}) {
    const Outcome out = run(stroke, 256, 24.6, 1000.0, kind);
    const GridGeometry& g = out.volume.geometry;
    std::size_t left = 0, beyond = 0;
    for (std::size_t n = 0; n < out.volume.hu.size(); ++n) {
      const Index3 v = g.indicesOf(n);
      const Vec3 p = g.toPatient_mm(Vec3(v[0], v[1], v[2]));
      if (glm::dot(p, kSlope) >= 0.0) continue;
      double nearest = 1e9;  // from the way of the ball's centre
      for (std::size_t leg = 0; leg + 1 < stroke.way_mm.size(); ++leg) {
        nearest = std::min(nearest, toSegment(p, stroke.way_mm[leg] + Vec3(0, 0, 3),
                                              stroke.way_mm[leg + 1] + Vec3(0, 0, 3)));
      }
      const bool bone = out.volume.hu[n] == kBoneHu;
      if (bone && nearest < 3.0 - 0.1) ++left;
      if (!bone && nearest > 3.0 + 0.1) ++beyond;
    }
    EXPECT_EQ(left, 0u);
    EXPECT_EQ(beyond, 0u);
    EXPECT_GT(out.voxels, 100000u);
  }
}

// Two burrs that cross in the same bone at the same time.
struct Crossing {
  std::string hash;
  std::uint64_t by_arm[2] = {};
  double paid[2] = {};  // voxels
  double credit_J[2] = {};
};
Crossing cross(bool swapped, RemovalKind kind) {
  HapticParameters p = test::oneArm();
  p.arms[0].tool = burrStroke(3.0, 1.0).tool;
  p.arms.push_back(p.arms[0]);
  p.arms[1].tool = *makeTool({ToolKind::burr, 30.0, 64, 2.0, 0, BurrShape::sphere, 0.0, 1.0});
  if (swapped) std::swap(p.arms[0], p.arms[1]);
  p.laws = {LawKind::viscous, LawKind::coulomb, LawKind::elastic};
  p.removal = kind;
  p.tissues.classes[0].solid = 1;
  p.journal_voxels = 2'000'000;
  Grid grid(slope(128, 24.6));
  HapticCore core(p, *grid.takeWriter());
  TickInput input;
  TickRecord record;
  const std::size_t big = swapped ? 1 : 0, small = 1 - big;
  for (int n = 0; n < 1500; ++n) {
    const double t = n / 1500.0;
    const double above = std::max(0.0, 4.0 - 20.0 * t);
    input.arms[big].position_m = 0.001 * Vec3(-4 + 8 * t, 0, -1.5 + above);
    input.arms[small].position_m = 0.001 * Vec3(4 - 8 * t, 1.0, -1.2 + above);
    input.journal = core.journalState();
    core.tick(input, nullptr, 0, record);
    ++input.tick;
  }
  Crossing out{volumeSha256(grid.snapshot()), {}, {}};
  for (int i = 0; i < 2; ++i) {
    const int arm = int(i == 0 ? big : small);
    out.by_arm[i] = core.journal().removed(arm, 0);
    out.paid[i] = double(core.journal().paid(arm)) / kVoxelShares;
    out.credit_J[i] = record.arms[std::size_t(arm)].cutting_credit_J;
  }
  return out;
}

TEST(Removal, TheOrderOfTwoArmsInOneVolumeChangesNothing) {
  for (RemovalKind kind : {RemovalKind::instant, RemovalKind::work}) {
    const Crossing one = cross(false, kind), other = cross(true, kind);
    EXPECT_EQ(one.hash, other.hash);
    EXPECT_EQ(one.by_arm[0] + one.by_arm[1], other.by_arm[0] + other.by_arm[1]);
    EXPECT_GT(one.by_arm[0], 1000u);
    EXPECT_GT(one.by_arm[1], 10u);
    EXPECT_EQ(one.credit_J[0], other.credit_J[0]);
    EXPECT_EQ(one.credit_J[1], other.credit_J[1]);
    EXPECT_EQ(one.paid[0] + one.paid[1], double(one.by_arm[0] + one.by_arm[1]));
    if (kind == RemovalKind::instant) {
      EXPECT_EQ(one.paid[0], double(one.by_arm[0])) << "nobody pays for what goes at once";
      continue;
    }
    EXPECT_EQ(one.paid[0], other.paid[0]);
    EXPECT_EQ(one.paid[1], other.paid[1]);
  }
}

TEST(Removal, TwoEqualToolsInOnePlacePayHalfOfAllEach) {
  for (RemovalKind kind : {RemovalKind::work, RemovalKind::instant}) {
    HapticParameters p = test::oneArm();
    p.arms[0].tool = burrStroke(3.0, 1.0).tool;
    p.arms.push_back(p.arms[0]);
    p.removal = kind;
    Grid grid(slope(64, 24.6));
    HapticCore core(p, *grid.takeWriter());
    TickInput input;
    TickRecord record;
    int taken[2] = {};
    for (; input.tick < 1000; ++input.tick) {
      const Vec3 tip_m = 0.001 * Vec3(0, 0, 1.0 - 0.002 * double(input.tick));
      input.arms[0].position_m = input.arms[1].position_m = tip_m;
      input.journal = core.journalState();
      core.tick(input, nullptr, 0, record);
      for (int arm = 0; arm < 2; ++arm) taken[arm] += record.arms[std::size_t(arm)].removed_voxels;
    }
    const std::uint64_t all = core.journal().removed(0, 0) + core.journal().removed(1, 0);
    ASSERT_GT(all, 50u);
    EXPECT_EQ(core.journal().entryCount(), all) << "one entry a voxel";
    EXPECT_EQ(std::uint64_t(taken[0] + taken[1]), all);
    const std::uint64_t half = kVoxelShares / 2 * all;
    EXPECT_EQ(core.journal().paid(0),
              kind == RemovalKind::work ? half : kVoxelShares * core.journal().removed(0, 0));
    EXPECT_EQ(core.journal().paid(1),
              kind == RemovalKind::work ? half : kVoxelShares * core.journal().removed(1, 0));
  }
}

TEST(Removal, AVoxelThatTwoArmsTookComesBackOnceWithTheNewerStroke) {
  HapticParameters p = test::oneArm();
  p.arms[0].tool = burrStroke(3.0, 1.0).tool;
  p.arms.push_back(p.arms[0]);
  p.removal = RemovalKind::work;
  Grid grid(slope(96, 24.6));
  const std::string before = volumeSha256(grid.snapshot());
  HapticCore core(p, *grid.takeWriter());
  TickInput input;
  TickRecord record;
  const auto tick = [&](double first_mm, double second_mm, Command command) {
    input.arms[0].position_m = 0.001 * Vec3(0, 0, first_mm);
    input.arms[1].position_m = 0.001 * Vec3(0, 0, second_mm);
    input.journal = core.journalState();
    core.tick(input, &command, command.kind == CommandKind::none ? 0 : 1, record);
    ++input.tick;
  };
  const auto undo = [&] {
    tick(8, 8, {CommandKind::undo, 0, {}});
    while (!core.acceptsCommands()) tick(8, 8, {});
  };
  // The first cuts alone for a while, then the second comes to it.
  for (int i = 0; i < 500; ++i) tick(-0.5, 8, {});
  const std::uint64_t alone = core.journal().removed(0, 0);
  ASSERT_GT(alone, 20u);
  for (int i = 0; i < 1500; ++i) tick(-0.5 - 0.0015 * i, -0.5 - 0.0015 * i, {});
  const std::uint64_t all = core.journal().removed(0, 0) + core.journal().removed(1, 0);
  ASSERT_GT(all, alone + 50u);
  EXPECT_EQ(core.journal().paid(0) + core.journal().paid(1), kVoxelShares * all);
  EXPECT_LT(core.journal().paid(1), kVoxelShares * core.journal().removed(1, 0))
      << "some of what its stroke holds was half paid by the other";
  const std::uint64_t entries = core.journal().entryCount();
  EXPECT_EQ(entries, all) << "one entry a voxel";

  for (int i = 0; i < 400; ++i) tick(8, 8, {});
  undo();  // the second arm's stroke is the newer one
  const std::uint64_t left = core.journal().removed(0, 0);
  EXPECT_EQ(core.journal().removed(1, 0), 0u);
  EXPECT_EQ(core.journal().paid(1), 0u) << "whatever it took is back";
  EXPECT_EQ(core.journal().paid(0), kVoxelShares * left);
  undo();
  EXPECT_EQ(core.journal().removed(0, 0), 0u);
  EXPECT_EQ(core.journal().paid(0), 0u);
  EXPECT_EQ(volumeSha256(grid.snapshot()), before);
}

// What is removed costs no more than the work of hand and motor.
TEST(Removal, CostsNoMoreWorkThanWasDone) {
  for (double motor_W : {0.0, 1.0}) {
    HapticParameters p = test::oneArm();
    p.arms[0].tool = motor_W > 0.0 ? burrStroke(motor_W, 1.0).tool : makeBlade(0.016, 64);
    p.laws = {LawKind::viscous, LawKind::coulomb, LawKind::elastic};
    p.removal = RemovalKind::work;
    p.tissues.classes[0].cutting_J_per_mm3 = motor_W > 0.0 ? 0.06 : 1e-4;
    Grid grid(slope(96, 24.6));
    HapticCore core(p, *grid.takeWriter());
    TickInput input;
    TickRecord record;
    double work_J = 0.0;
    Vec3 last_N(0.0);
    for (int n = 0; n < 4000; ++n) {
      const double t = n * 1e-3;
      input.arms[0].position_m =
          0.001 * Vec3(3 * std::sin(2 * t), 2 * std::sin(5 * t), 2.0 - 3.5 * std::sin(t));
      input.journal = core.journalState();
      core.tick(input, nullptr, 0, record);
      ++input.tick;
      const ArmRecord& arm = record.arms[0];
      work_J += -0.5 * glm::dot(arm.demanded_N + last_N, arm.velocity_m_s) * 1e-3;
      if (arm.tissue_class >= 0) work_J += motor_W * 1e-3;
      last_N = arm.demanded_N;
      const double spent_J = double(core.journal().removed(0, 0)) *
                             grid.geometry().voxelVolume_mm3() *
                             p.tissues.classes[0].cutting_J_per_mm3;
      ASSERT_LE(spent_J, work_J + 1e-9) << n;
    }
    EXPECT_GT(core.journal().removed(0, 0), 100u);
  }
}

// A motor that spins in air, or against what may not be cut, saves nothing up.
TEST(Removal, TheMotorSavesNothingUpInAir) {
  HapticParameters p = test::oneArm();
  p.arms[0].tool = burrStroke(40.0, 1.0).tool;
  p.removal = RemovalKind::work;
  Bench bench(p, slope(64, 24.6));
  for (int n = 0; n < 2000; ++n) bench.at({0, 0, 5});
  EXPECT_EQ(bench.record.arms[0].cutting_credit_J, 0.0);
}

TEST(Removal, CreditTurnsToHeatInAirToo) {
  HapticParameters p = test::oneArm();
  p.arms[0].tool = burrStroke(10.0, 1.0).tool;
  p.removal = RemovalKind::work;
  p.laws = {LawKind::coulomb};
  Bench bench(p, slope(64, 24.6));
  bench.push({0, 0, 3}, {0, 0, -1}, 400);
  for (int n = 0; n < 300; ++n) bench.at({0, 0, -1});
  ASSERT_GT(bench.record.arms[0].cutting_credit_J, 0.1);
  bench.push({0, 0, -1}, {0, 0, 6}, 100);
  for (int n = 0; n < 1000; ++n) bench.at({0, 0, 6});
  // What is left is worth two voxels.
  EXPECT_LE(bench.record.arms[0].cutting_credit_J, 2.0 * 0.05 * std::pow(24.6 / 64, 3) + 1e-6);
}

TEST(Removal, APoseThatJumpsDoesNoWork) {
  HapticParameters p = test::oneArm();
  p.arms[0].tool = makeBurr(0.003, 64, 0, 0.03);
  p.removal = RemovalKind::work;
  p.laws = {LawKind::viscous};
  Bench bench(p, slope(64, 24.6));
  bench.at({0, 0, 9});
  bench.at({0, 0, -3});
  EXPECT_EQ(bench.record.arms[0].cutting_credit_J, 0.0);
}

// A tool that stands on a row of voxels must not take its own axis for cleared while work is short.
TEST(Removal, LeavesNothingOnItsAxisWhenWorkWasShortAtFirst) {
  const Tool blade = makeBlade(0.010, 11);
  Grid grid(slope(64, 24.6));
  const TissueField tissue(grid, test::boneTable());
  Removal removal(blade, grid.geometry(), RemovalKind::work, 1e-3);
  Grid::Writer writer = *grid.takeWriter();
  std::vector<RemovedVoxel> removed;
  removed.reserve(Removal::kMostVoxels);
  const Vec3 on_a_voxel = grid.geometry().toPatient_mm({32, 32, 2});
  for (int n = 0; n < 400; ++n) {
    // It comes down along a row that it had no work for.
    const Vec3 at = on_a_voxel + Vec3(0, 0, std::max(0.0, 0.05 * (20 - n)));
    removal.giveWork(n < 30 ? 0.0 : 1.0, 1e3, tissue);
    removed.clear();
    removal.sweep(tissue, {at, {1, 0, 0, 0}}, removed);
    for (const RemovedVoxel& r : removed) writer.store(r.voxel[0], r.voxel[1], r.voxel[2], kAirHu);
  }
  for (int k = 3; k < 26; ++k) EXPECT_EQ(grid.hu(32, 32, k), kAirHu) << k;
}

TEST(Removal, SpendsNothingThatAnArmHasGivenBackSince) {
  Grid grid(slope(64, 24.6));
  const TissueField tissue(grid, test::boneTable());
  Removal removal(burrStroke(3.0, 1.0).tool, grid.geometry(), RemovalKind::work, 1e-3);
  std::vector<RemovedVoxel> removed;
  removed.reserve(Removal::kMostVoxels);
  const Pose inside{grid.geometry().toPatient_mm({32, 32, 4}), {1, 0, 0, 0}};
  removal.giveWork(1.0, 1.0, tissue);
  removal.giveWork(0.0, 0.0, tissue);  // all of it came back out of the springs
  EXPECT_GT(removal.credit_J(), 0.1);
  removal.sweep(tissue, inside, removed);
  EXPECT_TRUE(removed.empty());
  removal.giveWork(0.0, 0.5, tissue);
  for (int n = 0; n < 20; ++n) removal.sweep(tissue, inside, removed);
  double spent_J = 0.0;
  for (const RemovedVoxel& voxel : removed) spent_J += voxel.cost_J;
  EXPECT_GT(spent_J, 0.0);
  EXPECT_LE(spent_J, 0.5);
}

TEST(Removal, UndoGivesTheCreditBack) {
  HapticParameters p = test::oneArm();
  p.arms[0].tool = burrStroke(3.0, 1.0).tool;
  p.removal = RemovalKind::work;
  p.laws = {LawKind::coulomb};
  Bench bench(p, slope(64, 24.6));
  double at_the_beginning_J = -1.0;
  for (int n = 0; n < 400; ++n) {
    const ArmRecord& arm = bench.at({0, 0, 3.0 - 0.01 * n});
    if (at_the_beginning_J < 0.0 && arm.removed_voxels > 0) at_the_beginning_J = arm.cutting_credit_J;
  }
  ASSERT_GT(at_the_beginning_J, 0.0);
  ASSERT_NE(bench.record.arms[0].cutting_credit_J, at_the_beginning_J);
  bench.push({0, 0, -1}, {0, 0, 6}, 400);
  bench.at({0, 0, 6}, {{CommandKind::undo, 0, {}}});
  bench.settle();
  EXPECT_EQ(bench.core.journal().removed(0, 0), 0u);
  EXPECT_EQ(bench.at({0, 0, 6}).cutting_credit_J, at_the_beginning_J);
}

TEST(Removal, RewindLeadsToEverySecondAndForwardAgain) {
  HapticParameters p = test::oneArm();
  p.arms[0].tool = burrStroke(10.0, 1.0).tool;
  p.removal = RemovalKind::work;
  Bench bench(p, slope(64, 24.6));
  std::vector<std::string> seconds{volumeSha256(bench.grid.snapshot())};
  std::vector<std::uint64_t> removed{0};
  for (int n = 1; n <= 4000; ++n) {
    const double t = n * 1e-3;
    bench.at({4 * std::sin(2 * t), 2 * std::cos(3 * t), 1.0 - 0.6 * t});
    if (n % 1000 == 0) {
      // The mark of a second is made before what its tick removes.
      seconds.push_back("");
      removed.push_back(bench.core.journal().removed(0, 0) -
                        std::uint64_t(bench.record.arms[0].removed_voxels));
    }
  }
  for (int second : {3, 0, 2, 4, 1}) {
    bench.at({0, 0, 9}, {{CommandKind::rewind, second, {}}});
    bench.settle();
    EXPECT_EQ(bench.core.journal().removed(0, 0), removed[std::size_t(second)]) << second;
    EXPECT_EQ(bench.record.arms[0].sent_N, Vec3(0.0));
  }
  bench.at({0, 0, 9}, {{CommandKind::reset, 0, {}}});
  bench.settle();
  EXPECT_EQ(volumeSha256(bench.grid.snapshot()), seconds[0]);
}

}  // namespace
}  // namespace trephine
