// Tissues that are restricted to a label of a label map: where they are felt, cut and pushed by.
#include <cmath>
#include <numeric>

#include "base/rt/alloc_guard.h"
#include "haptics/contact_sphere.h"
#include "haptics_support.h"

namespace trephine {
namespace {

using test::Bench;

constexpr std::int16_t kHu = 50;
constexpr int kLiver = 0, kSoft = 1;

// 40^3 mm of one HU, with label 5 where x < 0 and label 6 beyond.
Volume block() {
  Volume volume;
  volume.geometry.size = {40, 40, 40};
  volume.geometry.origin_mm = Vec3(-19.5);
  volume.hu.assign(volume.geometry.voxelCount(), kHu);
  return volume;
}
std::shared_ptr<const LabelMap> halves() {
  LabelMap map{block().geometry, std::vector<std::uint8_t>(block().hu.size())};
  for (std::size_t i = 0; i < map.labels.size(); ++i) {
    map.labels[i] = map.geometry.indicesOf(i)[0] < 20 ? 5 : 6;
  }
  return std::make_shared<const LabelMap>(std::move(map));
}

// A liver of label 5 whatever its HU; soft tissue of any voxel is added or not.
TissueTable liver(bool soft = false) {
  TissueTable table;
  table.count = soft ? 2 : 1;
  table.classes[kLiver] = {{4.0, 400.0, 0.5, 0.0, 1e-5}, -1000, 1000, 1, 5};
  table.classes[kSoft] = {{2.0, 100.0, 0.2, 0.0, 1e-5}, 0, 100, 1, 0};
  return table;
}

struct LabelledBench {
  LabelledBench(const HapticParameters& p, std::shared_ptr<const LabelMap> labels)
      : grid(block(), std::move(labels)), core(p, *grid.takeWriter()) {}
  const ArmRecord& at(const Vec3& tip_mm, std::vector<Command> commands = {}) {
    TickInput input;
    input.tick = tick++;
    input.journal = core.journalState();
    input.arms[0].position_m = tip_mm / 1000.0;
    core.tick(input, commands.data(), commands.size(), record);
    return record.arms[0];
  }
  Grid grid;
  HapticCore core;
  TickRecord record;
  std::uint64_t tick = 0;
};

HapticParameters burring(const TissueTable& tissues) {
  HapticParameters p = test::oneArm();
  p.arms[0].tool = makeBurr(0.003, 64, 8, 0.03);
  p.tissues = tissues;
  p.laws = {LawKind::viscous, LawKind::coulomb, LawKind::elastic};
  p.force_at = ForceAt::distributed;
  return p;
}

TEST(Labels, ALookUpAnswersAsClassifyDoesForEveryHuAndLabel) {
  TissueTable table = liver(true);
  table.count = 4;
  table.classes[2] = {{1, 1, 1, 0, 0}, 50, 300, 1, 6};
  table.classes[3] = {{1, 1, 1, 0, 0}, -2000, -10, 1, 255};
  Volume volume;
  volume.geometry.size = {65536, 1, 1};
  for (int hu = -32768; hu <= 32767; ++hu) volume.hu.push_back(std::int16_t(hu));
  TissueLookup lookup;
  lookup.set(table);
  for (int label : {0, 1, 5, 6, 255}) {
    const auto map = std::make_shared<const LabelMap>(
        LabelMap{volume.geometry, std::vector(volume.hu.size(), std::uint8_t(label))});
    const Grid grid(volume, map);
    for (std::size_t n = 0; n < volume.hu.size(); ++n) {
      ASSERT_EQ(lookup.classAt(grid, n), classify(table, volume.hu[n], label))
          << volume.hu[n] << " " << label;
    }
  }
  const Grid unlabelled(volume);
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    ASSERT_EQ(lookup.classAt(unlabelled, n), classify(table, volume.hu[n])) << volume.hu[n];
  }
}

TEST(Labels, ATipFeelsTheTissueOfTheLabelItIsIn) {
  HapticParameters p = test::oneArm();
  p.tissues = liver(true);
  for (TissueClass& t : p.tissues.classes) t.cuttable = 0;
  LabelledBench bench(p, halves());
  EXPECT_EQ(bench.at({-10, 0, 0}).tissue_class, kLiver);
  EXPECT_EQ(bench.at({10, 0, 0}).tissue_class, kSoft);
  p.tissues.count = 1;
  LabelledBench alone(p, halves());
  EXPECT_EQ(alone.at({-10, 0, 0}).tissue_class, kLiver);
  EXPECT_EQ(alone.at({10, 0, 0}).tissue_class, -1);
}

TEST(Labels, AToolRemovesOnlyWhatHasTheLabel) {
  for (RemovalKind kind : {RemovalKind::instant, RemovalKind::work}) {
    HapticParameters p = burring(liver());
    p.removal = kind;
    p.arms[0].tool.made_from.motor_W = 10.0;
    LabelledBench bench(p, halves());
    for (int n = 0; n <= 2000; ++n) bench.at({8.0 - 0.008 * n, 0, 0});
    int inside = 0;
    for (std::size_t i = 0; i < block().hu.size(); ++i) {
      if (bench.grid.hu(i) == kHu) continue;
      ++inside;
      ASSERT_EQ(bench.grid.label(i), 5);
    }
    EXPECT_GT(inside, 100);
    EXPECT_EQ(bench.core.journal().removed(0, kLiver), std::uint64_t(inside));
  }
}

// Its range holds -1000, which is what removal leaves.
TEST(Labels, WhatWasRemovedIsNoTissueAnyMore) {
  HapticParameters p = burring(liver());
  p.laws = {LawKind::coulomb};
  LabelledBench bench(p, halves());
  for (int n = 0; n < 1600; ++n) bench.at({6 - 0.01 * n, 0, 0});
  for (int n = 0; n < 400; ++n) bench.at({-10 + 0.01 * n, 0, 0});
  const std::uint64_t removed = bench.core.journal().removed(0, kLiver);
  ASSERT_GT(removed, 50u);
  // A needle and a small ball fit into the hole.
  HapticParameters needle = test::oneArm();
  needle.tissues = liver();
  Grid hole(bench.grid.snapshot(), halves());
  StiffnessByLabel stiffness;
  stiffness.set(needle.tissues);
  const ElasticPush push = ContactSphere(hole.geometry(), 1.0, kBluntDirections)
                               .push(TissueField(hole, needle.tissues), stiffness, {-8, 0, 3});
  EXPECT_EQ(push.at_centre, 0.0);
  EXPECT_EQ(push.force_N, Vec3(0.0));
  HapticCore core(needle, *hole.takeWriter());
  TickInput input;
  TickRecord record;
  input.arms[0].position_m = Vec3(-8, 0, 3) / 1000.0;
  for (int n = 0; n < 8; ++n) core.tick(input, nullptr, 0, record);
  EXPECT_EQ(record.arms[0].tissue_class, -1);
  EXPECT_EQ(core.journal().removed(0, kLiver), 0u);
}

TEST(Labels, ALabelMapChangesNothingForTissuesWithoutLabels) {
  HapticParameters p = burring(liver(true));
  p.tissues.classes[kLiver] = {{4.0, 400.0, 0.5, 0.0, 1e-5}, 101, 1000, 1, 0};
  p.removal = RemovalKind::work;
  p.arms[0].tool.made_from.motor_W = 4.0;
  LabelledBench with(p, halves()), without(p, nullptr);
  for (int n = 0; n < 1500; ++n) {
    const Vec3 tip(12.0 - 0.012 * n, 2.0 * std::sin(0.01 * n), 22.0 - 0.02 * n);
    ASSERT_EQ(with.at(tip).sent_N, without.at(tip).sent_N) << n;
    ASSERT_EQ(with.record.arms[0].demanded_N, without.record.arms[0].demanded_N) << n;
  }
  EXPECT_GT(with.core.journal().removed(0, kSoft), 100u);
  EXPECT_EQ(volumeSha256(with.grid.snapshot()), volumeSha256(without.grid.snapshot()));
}

TEST(Labels, ATissueOfALabelIsNowhereWithoutALabelMap) {
  LabelledBench bench(burring(liver()), nullptr);
  for (int n = 0; n < 200; ++n) {
    ASSERT_EQ(bench.at({-8.0 + 0.08 * n, 0, 0}).tissue_class, -1);
    ASSERT_EQ(bench.record.arms[0].demanded_N, Vec3(0.0));
  }
  EXPECT_EQ(volumeSha256(bench.grid.snapshot()), volumeSha256(block()));
}

TEST(Labels, AChangeOfTissuesMayMoveATissueToAnotherLabelAndAllocatesNothing) {
  HapticParameters p = burring(liver());
  p.tissues.classes[kLiver].cuttable = 0;
  LabelledBench bench(p, halves());
  TissueTable moved = p.tissues;
  moved.classes[kLiver].label = 6;
  const Command other{CommandKind::tissues, 0, &moved};
  EXPECT_EQ(bench.at({-10, 0, 0}).tissue_class, kLiver);
  TickInput input;
  input.tick = bench.tick;
  input.journal = bench.core.journalState();
  input.arms[0].position_m = Vec3(-10, 0, 0) / 1000.0;
  const std::uint64_t before = rt::guardedAllocations();
  {
    rt::NoAllocation guard;
    bench.core.tick(input, &other, 1, bench.record);
  }
  EXPECT_EQ(rt::guardedAllocations(), before);
  EXPECT_EQ(bench.record.arms[0].tissue_class, -1);
  // Until the bricks are counted anew the tool looks for solid tissue on its way.
  for (int n = 0; n < 8; ++n) bench.at({10, 0, 0});
  EXPECT_EQ(bench.record.arms[0].tissue_class, kLiver);
}

// Of one HU throughout: the border is the label's alone, at x = 0.
ElasticPush pushAt(const Vec3& centre_mm, double radius_mm, const TissueTable& tissues) {
  static const Grid grid(block(), halves());
  StiffnessByLabel stiffness;
  stiffness.set(tissues);
  static const GridGeometry geometry = block().geometry;
  return ContactSphere(geometry, radius_mm, kBluntDirections)
      .push(TissueField(grid, tissues), stiffness, centre_mm);
}

TEST(Labels, ABorderBetweenLabelsPushesByStiffnessTimesDepth) {
  for (double depth_mm : {1.0, 2.0, 3.0}) {
    const ElasticPush push = pushAt({4.0 - depth_mm, 0.3, 0.2}, 4.0, liver());
    EXPECT_NEAR(push.force_N.x, 1e-3 * 400.0 * depth_mm, 0.08 * 400.0 * 1e-3 * depth_mm + 0.03);
    EXPECT_LT(std::hypot(push.force_N.y, push.force_N.z), 0.1 * push.force_N.x);
  }
  EXPECT_NEAR(pushAt({1.0, 0.3, 0.2}, 4.0, liver()).stiffness, 400.0, 1.0);
  // Softer tissue beyond it takes its part back.
  const ElasticPush both = pushAt({2.0, 0.3, 0.2}, 4.0, liver(true));
  EXPECT_NEAR(both.force_N.x, 1e-3 * 300.0 * 2.0, 0.1);
  EXPECT_NEAR(pushAt({-10, 0, 0}, 4.0, liver()).force_N.x, 0.0, 1e-12) << "evenly surrounded";
  EXPECT_EQ(pushAt({-10, 0, 0}, 4.0, liver()).at_centre, 400.0);
  EXPECT_EQ(pushAt({10, 0, 0}, 4.0, liver()).force_N, Vec3(0.0));
}

// Half of a liver whose range holds -1000 HU was cut away above z = 0, between two voxels.
TEST(Labels, ACutSurfacePushesFromWhereItIsAlsoWhenTheRangeHoldsAir) {
  Volume volume = block();
  std::fill(volume.hu.begin() + std::ptrdiff_t(volume.hu.size() / 2), volume.hu.end(), kAirHu);
  const LabelMap all{volume.geometry, std::vector(volume.hu.size(), std::uint8_t(5))};
  const Grid grid(volume, std::make_shared<const LabelMap>(all));
  const TissueField tissue(grid, liver());
  StiffnessByLabel stiffness;
  stiffness.set(liver());
  const ContactSphere ball(grid.geometry(), 4.0, kBluntDirections);
  for (double depth_mm : {1.0, 2.0}) {
    const Vec3 centre(0.2, 0.1, 4.0 - depth_mm);
    const ElasticPush push = ball.push(tissue, stiffness, centre);
    EXPECT_NEAR(push.force_N.z, 1e-3 * 400.0 * depth_mm, 0.06);
  }
}

TEST(Labels, ABorderBetweenLabelsHasNoSteps) {
  double last_N = pushAt({4.5, 0.0, 0.0}, 4.0, liver()).force_N.x;
  for (int n = 1; n <= 350; ++n) {
    const double x_mm = 4.5 - 0.01 * n;
    const double now_N = pushAt({x_mm, 0.003 * n, 0.0}, 4.0, liver()).force_N.x;
    // By Hooke 4 mN a step.
    ASSERT_NEAR(now_N - last_N, 0.004, 0.006) << x_mm;
    last_N = now_N;
  }
}

}  // namespace
}  // namespace trephine
