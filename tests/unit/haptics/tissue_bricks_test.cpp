#include "haptics/tissue_bricks.h"

#include "haptics_support.h"

namespace trephine {
namespace {

// 32^3 voxels, bone in the lower 16 slices: 8 bricks, 4 of them empty.
struct Bricks {
  Bricks() : grid(test::boneSlab()), writer(*grid.takeWriter()) {
    lookup.set(test::boneTable());
    bricks.emplace(grid, lookup);
  }
  bool above() const { return bricks->mayHold(Vec3(4, 4, 20), Vec3(12, 12, 28)); }
  bool below() const { return bricks->mayHold(Vec3(4, 4, 4), Vec3(12, 12, 12)); }

  Grid grid;
  Grid::Writer writer;
  TissueLookup lookup;
  std::optional<TissueBricks> bricks;
};

TEST(TissueBricks, AreCountedAnewABrickATickAfterAnotherTissueIsMeant) {
  Bricks b;
  EXPECT_FALSE(b.above());
  EXPECT_TRUE(b.below());
  b.bricks->markAll();
  EXPECT_TRUE(b.above()) << "unknown";
  for (int tick = 0; tick < 8; ++tick) b.bricks->recount(b.grid, b.lookup);
  EXPECT_EQ(b.bricks->unknown(), 0u);
  EXPECT_FALSE(b.above());
  EXPECT_TRUE(b.below());
}

TEST(TissueBricks, ABrickToWhichTissueCameBackIsFullAtOnceAndEmptyAgainWhenItWent) {
  Bricks b;
  const std::size_t voxel = b.grid.geometry().indexOf(8, 8, 24);
  b.writer.store(voxel, test::kBoneHu);
  b.bricks->mark(b.grid.brickOf(voxel));
  EXPECT_TRUE(b.above());
  b.bricks->recount(b.grid, b.lookup);
  EXPECT_EQ(b.bricks->unknown(), 0u);
  EXPECT_TRUE(b.above());
  b.writer.store(voxel, kAirHu);
  b.bricks->remove({8, 8, 24}, false);
  EXPECT_FALSE(b.above()) << "counted, not just unknown";
}

TEST(TissueBricks, WhatIsRemovedWhileABrickIsUnknownIsCountedWithIt) {
  Bricks b;
  const std::size_t voxel = b.grid.geometry().indexOf(8, 8, 24);
  b.writer.store(voxel, test::kBoneHu);
  b.bricks->mark(b.grid.brickOf(voxel));
  b.writer.store(voxel, kAirHu);
  b.bricks->remove({8, 8, 24}, false);
  b.bricks->recount(b.grid, b.lookup);
  EXPECT_FALSE(b.above());
}

// The fast path through air is back once an undo is done.
TEST(HapticCore, KnowsWhichBricksAreEmptyAfterAnUndoAndAfterAnEditOfRanges) {
  HapticParameters p = test::oneArm();
  test::Bench bench(p);
  const auto unknown = [&] { return bench.core.unknownBricks(); };
  bench.push({0, 0, 2}, {0, 0, -4}, 500);
  bench.at({0, 0, 8}, {{CommandKind::undo, 0, {}}});
  bench.settle();
  for (int i = 0; i < 2; ++i) bench.at({0, 0, 8});
  EXPECT_EQ(unknown(), 0u);
  TissueTable wider = p.tissues;
  wider.classes[0].hu_min = 100;
  bench.at({0, 0, 8}, {{CommandKind::tissues, 0, &wider}});
  EXPECT_GT(unknown(), 4u);
  for (int i = 0; i < 8; ++i) bench.at({0, 0, 8});
  EXPECT_EQ(unknown(), 0u);
  wider.classes[0].damping_Ns_per_m = 3.0;
  bench.at({0, 0, 8}, {{CommandKind::tissues, 0, &wider}});
  EXPECT_EQ(unknown(), 0u) << "its damping moves no voxel";
}

}  // namespace
}  // namespace trephine
