#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>

#include "volume/grid.h"
#include "volumes.h"

namespace trephine {
namespace {

using test::patternVolume;

std::size_t countDifferences(const Volume& a, const Volume& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.hu.size(); ++i) count += a.hu[i] != b.hu[i];
  return count;
}

TEST(Grid, AVoxelOutsideIsAir) {
  const Grid grid(patternVolume({4, 5, 6}));
  EXPECT_EQ(grid.hu(-1, 0, 0), kAirHu);
  EXPECT_EQ(grid.hu(0, 5, 0), kAirHu);
  EXPECT_EQ(grid.hu(0, 0, 6), kAirHu);
  EXPECT_EQ(grid.hu(3, 4, 5), patternVolume({4, 5, 6}).at(3, 4, 5));
}

TEST(Grid, KnowsTheLabelOfEachVoxelWhereThereIsALabelMap) {
  const Volume volume = patternVolume({4, 5, 6});
  EXPECT_EQ(Grid(volume).label(7), 0);
  LabelMap map{volume.geometry, std::vector<std::uint8_t>(volume.hu.size())};
  map.labels[7] = 5;
  const Grid grid(volume, std::make_shared<const LabelMap>(map));
  EXPECT_EQ(grid.label(6), 0);
  EXPECT_EQ(grid.label(7), 5);
}

TEST(Grid, HasOneWriterAtATime) {
  Grid grid(patternVolume({4, 4, 4}));
  auto first = grid.takeWriter();
  ASSERT_TRUE(first);
  EXPECT_FALSE(grid.takeWriter());
  first.reset();
  EXPECT_TRUE(grid.takeWriter());
}

TEST(Grid, AMovedWriterKeepsTheRightAndGivesItBackOnce) {
  Grid grid(patternVolume({4, 4, 4}));
  {
    auto first = grid.takeWriter();
    Grid::Writer moved = std::move(*first);
    first.reset();
    EXPECT_FALSE(grid.takeWriter());
    moved.store(5, 77);
  }
  EXPECT_EQ(grid.hu(std::size_t(5)), 77);
  EXPECT_TRUE(grid.takeWriter());
}

TEST(Grid, StoreReturnsWhatWasThere) {
  const Volume volume = patternVolume({4, 4, 4});
  Grid grid(volume);
  auto writer = grid.takeWriter();
  EXPECT_EQ(writer->store(9, 123), volume.hu[9]);
  EXPECT_EQ(writer->store(9, 5), 123);
}

// Edges that are powers of two, others, and one voxel: the numbers are divided in another way.
TEST(Grid, StoreByThreeNumbersIsStoreByTheOne) {
  for (const Index3& size : {Index3{64, 32, 20}, Index3{49, 33, 20}, Index3{1, 100, 20},
                             Index3{100, 1, 20}, Index3{1, 1, 70}, Index3{17, 16, 40}}) {
    Grid by_number(patternVolume(size)), by_three(patternVolume(size));
    auto one = by_number.takeWriter(), other = by_three.takeWriter();
    Volume copy = by_number.snapshot(), other_copy = copy;
    for (int k = 0; k < size[2]; ++k) {
      for (int j = 0; j < size[1]; ++j) {
        for (int i = 0; i < size[0]; ++i) {
          const std::size_t index = by_number.geometry().indexOf(i, j, k);
          ASSERT_EQ(one->store(index, 7), other->store(i, j, k, 7));
          std::vector<VoxelBox> boxes, other_boxes;
          by_number.copyChanges(copy, boxes);
          by_three.copyChanges(other_copy, other_boxes);
          ASSERT_EQ(boxes, other_boxes);
          ASSERT_EQ(copy.hu[index], 7);
          ASSERT_EQ(other_copy.hu[index], 7);
        }
      }
    }
  }
}

TEST(Grid, NothingChangedMeansNothingCopied) {
  Grid grid(patternVolume({40, 20, 20}));
  Volume copy = grid.snapshot();
  copy.hu[0] = 31000;
  std::vector<VoxelBox> boxes;
  grid.copyChanges(copy, boxes);
  EXPECT_TRUE(boxes.empty());
  EXPECT_EQ(copy.hu[0], 31000);
}

TEST(Grid, CopiesExactlyTheBricksThatChanged) {
  const Volume start = patternVolume({50, 40, 35});
  Grid grid(start);
  Volume copy = start;
  for (auto& hu : copy.hu) hu = 9;  // so that whatever is copied shows
  {
    auto writer = grid.takeWriter();
    writer->store(start.geometry.indexOf(17, 2, 3), 500);    // brick (1, 0, 0)
    writer->store(start.geometry.indexOf(49, 39, 34), 600);  // the cut-off last brick (3, 2, 2)
  }
  std::vector<VoxelBox> boxes;
  grid.copyChanges(copy, boxes);
  ASSERT_EQ(boxes.size(), 2u);
  EXPECT_EQ(boxes[0], (VoxelBox{{16, 0, 0}, {32, 16, 16}}));
  EXPECT_EQ(boxes[1], (VoxelBox{{48, 32, 32}, {50, 40, 35}}));
  for (int k = 0; k < 35; ++k) {
    for (int j = 0; j < 40; ++j) {
      for (int i = 0; i < 50; ++i) {
        const bool inside =
            (i >= 16 && i < 32 && j < 16 && k < 16) || (i >= 48 && j >= 32 && k >= 32);
        ASSERT_EQ(copy.at(i, j, k), inside ? grid.hu(i, j, k) : 9) << i << " " << j << " " << k;
      }
    }
  }
  boxes.clear();
  grid.copyChanges(copy, boxes);
  EXPECT_TRUE(boxes.empty()) << "marks are taken once";
}

TEST(Grid, MergesBricksThatAreNeighboursAlongI) {
  const Volume start = patternVolume({64, 32, 16});
  Grid grid(start);
  auto writer = grid.takeWriter();
  for (int i : {0, 16, 32}) writer->store(start.geometry.indexOf(i, 0, 0), 1);
  writer->store(start.geometry.indexOf(0, 16, 0), 1);
  writer->store(start.geometry.indexOf(63, 31, 0), 1);
  Volume copy = start;
  std::vector<VoxelBox> boxes;
  grid.copyChanges(copy, boxes);
  ASSERT_EQ(boxes.size(), 3u);
  EXPECT_EQ(boxes[0], (VoxelBox{{0, 0, 0}, {48, 16, 16}}));
  EXPECT_EQ(boxes[1], (VoxelBox{{0, 16, 0}, {16, 32, 16}}));
  EXPECT_EQ(boxes[2], (VoxelBox{{48, 16, 0}, {64, 32, 16}}));
}

TEST(Grid, DoesNotMergeBricksOfDifferentRowsOrSlices) {
  const Volume start = patternVolume({32, 32, 32});
  for (const Index3& second : {Index3{16, 16, 0}, Index3{16, 0, 16}}) {
    Grid grid(start);
    auto writer = grid.takeWriter();
    writer->store(0, 1);
    writer->store(start.geometry.indexOf(second[0], second[1], second[2]), 1);
    Volume copy = start;
    std::vector<VoxelBox> boxes;
    grid.copyChanges(copy, boxes);
    EXPECT_EQ(boxes.size(), 2u);
  }
}

TEST(Grid, MarksMoreBricksThanOneWordHolds) {
  const Volume start = patternVolume({16, 16, 16 * 150});
  Grid grid(start);
  auto writer = grid.takeWriter();
  for (int k = 0; k < 150; k += 7) writer->store(start.geometry.indexOf(3, 3, 16 * k), 2222);
  Volume copy = start;
  std::vector<VoxelBox> boxes;
  grid.copyChanges(copy, boxes);
  EXPECT_EQ(boxes.size(), 22u);
  EXPECT_EQ(countDifferences(copy, grid.snapshot()), 0u);
  EXPECT_EQ(countDifferences(copy, start), 22u);
}

TEST(Grid, AReaderBesideAWriterEndsWithTheSameVoxels) {
  const Volume start = patternVolume({70, 60, 50});
  Grid grid(start);
  Volume copy = start;
  std::atomic<bool> done{false}, reading{false};
  std::thread thread([&] {
    auto writer = grid.takeWriter();
    while (!reading) std::this_thread::yield();
    std::uint64_t state = 1;
    for (int n = 0; n < 300000; ++n) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      writer->store(std::size_t(state >> 33) % start.hu.size(), std::int16_t(state >> 20));
    }
    done = true;
  });
  std::vector<VoxelBox> boxes;
  while (!done) {
    boxes.clear();
    grid.copyChanges(copy, boxes);
    reading = true;
  }
  thread.join();
  grid.copyChanges(copy, boxes);
  EXPECT_EQ(volumeSha256(copy), volumeSha256(grid.snapshot()));
  EXPECT_NE(volumeSha256(copy), volumeSha256(start));
}

}  // namespace
}  // namespace trephine
