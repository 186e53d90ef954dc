#include <gtest/gtest.h>

#include "volume/carve_journal.h"
#include "volumes.h"

namespace trephine {
namespace {

using test::patternVolume;

// A grid with its writer, a journal, and a way to finish a job.
class CarveJournalTest : public ::testing::Test {
 protected:
  void carve(int arm, std::initializer_list<std::size_t> voxels, int tissue_class = 0) {
    for (std::size_t voxel : voxels) {
      ASSERT_TRUE(journal.erase(writer, arm, voxel, tissue_class)) << voxel;
    }
  }
  void stroke(int arm, std::initializer_list<std::size_t> voxels, int tissue_class = 0) {
    ASSERT_TRUE(journal.beginStroke(arm));
    carve(arm, voxels, tissue_class);
    journal.endStroke(arm);
  }
  int finish(std::size_t voxels_a_step = 1000) {
    int steps = 1;
    while (journal.step(writer, voxels_a_step)) ++steps;
    return steps;
  }
  bool isAir(std::size_t voxel) const { return grid.hu(voxel) == kAirHu; }
  bool isBack(std::size_t voxel) const { return grid.hu(voxel) == start.hu[voxel]; }
  std::string hash() const { return volumeSha256(grid.snapshot()); }

  const Volume start = patternVolume({20, 20, 20});
  Grid grid{start};
  Grid::Writer writer{std::move(*grid.takeWriter())};
  CarveJournal journal{1000, 20};
};

TEST_F(CarveJournalTest, ErasesOnlyInsideAStroke) {
  EXPECT_FALSE(journal.erase(writer, 0, 5, 0));
  EXPECT_EQ(hash(), volumeSha256(start));
  ASSERT_TRUE(journal.beginStroke(0));
  EXPECT_TRUE(journal.inStroke(0));
  EXPECT_FALSE(journal.inStroke(1));
  EXPECT_TRUE(journal.erase(writer, 0, 5, 0));
  EXPECT_TRUE(isAir(5));
  journal.endStroke(0);
  EXPECT_FALSE(journal.inStroke(0));
  EXPECT_FALSE(journal.erase(writer, 0, 6, 0));
  EXPECT_TRUE(isBack(6));
}

TEST_F(CarveJournalTest, UndoPutsTheLastStrokeBackAndRedoTakesItAgain) {
  stroke(0, {1, 2, 3});
  const std::string after_first = hash();
  stroke(0, {10, 11});
  const std::string after_second = hash();
  ASSERT_TRUE(journal.startUndo());
  finish();
  EXPECT_EQ(hash(), after_first);
  ASSERT_TRUE(journal.startUndo());
  finish();
  EXPECT_EQ(hash(), volumeSha256(start));
  EXPECT_FALSE(journal.startUndo());
  ASSERT_TRUE(journal.startRedo());
  finish();
  EXPECT_EQ(hash(), after_first);
  ASSERT_TRUE(journal.startRedo());
  finish();
  EXPECT_EQ(hash(), after_second);
  EXPECT_FALSE(journal.startRedo());
}

TEST_F(CarveJournalTest, StrokesOfTwoArmsThatInterleaveAreUndoneApart) {
  ASSERT_TRUE(journal.beginStroke(0));
  carve(0, {1});
  ASSERT_TRUE(journal.beginStroke(1));
  carve(1, {100});
  carve(0, {2});
  carve(1, {101, 102});
  carve(0, {3});
  ASSERT_TRUE(journal.startUndo(0));
  finish();
  for (std::size_t voxel : {1, 2, 3}) EXPECT_TRUE(isBack(voxel));
  for (std::size_t voxel : {100, 101, 102}) EXPECT_TRUE(isAir(voxel));
  ASSERT_TRUE(journal.startRedo());
  finish();
  for (std::size_t voxel : {1, 2, 3, 100, 101, 102}) EXPECT_TRUE(isAir(voxel));
  ASSERT_TRUE(journal.startUndo(1));
  finish();
  for (std::size_t voxel : {1, 2, 3}) EXPECT_TRUE(isAir(voxel));
  for (std::size_t voxel : {100, 101, 102}) EXPECT_TRUE(isBack(voxel));
}

TEST_F(CarveJournalTest, AStrokeInTheMiddleCanBeUndoneAloneAndOnlyOnce) {
  stroke(0, {1, 2});
  stroke(1, {3, 4});
  stroke(0, {5});
  ASSERT_TRUE(journal.startUndo(1));
  finish();
  EXPECT_TRUE(isAir(1) && isAir(2) && isBack(3) && isBack(4) && isAir(5));
  EXPECT_FALSE(journal.startUndo(1));
  EXPECT_FALSE(journal.startUndo(7));
  ASSERT_TRUE(journal.startUndo());
  finish();
  EXPECT_TRUE(isBack(5));
  ASSERT_TRUE(journal.startUndo());
  finish();
  EXPECT_EQ(hash(), volumeSha256(start));
}

TEST_F(CarveJournalTest, AVoxelThatCameBackCanBeErasedByALaterStroke) {
  stroke(0, {1, 2});
  stroke(0, {3});
  ASSERT_TRUE(journal.startUndo(0));
  finish();
  stroke(1, {2, 4});
  EXPECT_TRUE(isBack(1) && isAir(2) && isAir(3) && isAir(4));
  ASSERT_TRUE(journal.startUndo());
  finish();
  EXPECT_TRUE(isBack(2) && isBack(4) && isAir(3));
  ASSERT_TRUE(journal.startReset());
  finish();
  EXPECT_EQ(hash(), volumeSha256(start));
}

TEST_F(CarveJournalTest, AnErasedVoxelIsNotErasedTwice) {
  stroke(0, {1, 2});
  stroke(1, {2, 3});
  EXPECT_EQ(journal.removed(1, 0), 1u);
  ASSERT_TRUE(journal.startUndo(0));
  finish();
  ASSERT_TRUE(journal.startUndo(1));
  finish();
  EXPECT_EQ(hash(), volumeSha256(start)) << "in whatever order strokes are undone";
}

TEST_F(CarveJournalTest, ANewStrokeDropsWhatCouldBeRedone) {
  stroke(0, {1, 2});
  stroke(0, {3});
  ASSERT_TRUE(journal.startUndo());
  finish();
  stroke(0, {4});
  EXPECT_FALSE(journal.startRedo());
  EXPECT_TRUE(isBack(3) && isAir(4));
  EXPECT_EQ(journal.strokeCount(), 2u);
  EXPECT_EQ(journal.entryCount(), 3u) << "the room of the dropped stroke is used again";
}

TEST_F(CarveJournalTest, ADroppedStrokeAmongAnothersEntriesDoesNotComeBack) {
  ASSERT_TRUE(journal.beginStroke(0));
  ASSERT_TRUE(journal.beginStroke(1));
  carve(0, {1});
  carve(1, {50});
  carve(0, {2});
  ASSERT_TRUE(journal.startUndo(1));
  finish();
  stroke(1, {60});  // takes the dropped stroke's number
  ASSERT_TRUE(journal.startUndo(1));
  finish();
  EXPECT_TRUE(isBack(60) && isBack(50) && isAir(1) && isAir(2));
  ASSERT_TRUE(journal.startRedo());
  finish();
  EXPECT_TRUE(isAir(60) && isBack(50));
  ASSERT_TRUE(journal.startReset());
  finish();
  EXPECT_EQ(hash(), volumeSha256(start));
}

TEST_F(CarveJournalTest, ResetRestoresTheExactVolumeAndForgets) {
  EXPECT_FALSE(journal.startReset()) << "there is nothing to reset";
  for (std::size_t v = 0; v < 19; ++v) stroke(int(v) % 2, {v * 300, v * 300 + 1}, int(v % 4));
  ASSERT_TRUE(journal.startUndo());
  finish();
  ASSERT_TRUE(journal.startReset());
  finish();
  EXPECT_EQ(hash(), volumeSha256(start));
  EXPECT_EQ(journal.strokeCount(), 0u);
  EXPECT_EQ(journal.entryCount(), 0u);
  EXPECT_FALSE(journal.startUndo());
  EXPECT_FALSE(journal.startRedo());
  for (int arm = 0; arm < 2; ++arm) {
    for (int c = 0; c < kMaxClasses; ++c) EXPECT_EQ(journal.removed(arm, c), 0u);
  }
}

TEST_F(CarveJournalTest, WorksInSlicesAndRefusesOtherWorkMeanwhile) {
  ASSERT_TRUE(journal.beginStroke(0));
  for (std::size_t voxel = 0; voxel < 100; ++voxel) carve(0, {voxel});
  ASSERT_TRUE(journal.startUndo());
  EXPECT_FALSE(journal.inStroke(0)) << "an open stroke is ended first";
  EXPECT_TRUE(journal.step(writer, 30));
  EXPECT_TRUE(isBack(99) && isBack(70) && isAir(69));
  EXPECT_TRUE(journal.busy());
  EXPECT_FALSE(journal.startUndo());
  EXPECT_FALSE(journal.startRedo());
  EXPECT_FALSE(journal.startReset());
  EXPECT_FALSE(journal.beginStroke(0));
  EXPECT_FALSE(journal.erase(writer, 0, 500, 0));
  EXPECT_GE(finish(30), 3);
  EXPECT_FALSE(journal.busy());
  EXPECT_EQ(hash(), volumeSha256(start));
}

TEST_F(CarveJournalTest, AStepVisitsAtMostEightTimesItsVoxels) {
  ASSERT_TRUE(journal.beginStroke(0));
  ASSERT_TRUE(journal.beginStroke(1));
  carve(0, {0});
  for (std::size_t voxel = 1; voxel <= 200; ++voxel) carve(1, {voxel});
  carve(0, {201});
  ASSERT_TRUE(journal.startUndo(0));
  // 202 entries lie between its first and last; a step of 5 visits 40 of them.
  EXPECT_EQ(finish(5), 6);
  EXPECT_TRUE(isBack(0) && isBack(201) && isAir(100));
}

TEST_F(CarveJournalTest, CountsWhatIsRemovedNowByArmAndClass) {
  stroke(0, {1, 2, 3}, 2);
  stroke(1, {4}, 2);
  stroke(0, {5, 6}, 7);
  EXPECT_EQ(journal.removed(0, 2), 3u);
  EXPECT_EQ(journal.removed(1, 2), 1u);
  EXPECT_EQ(journal.removed(0, 7), 2u);
  ASSERT_TRUE(journal.startUndo(0));
  finish();
  EXPECT_EQ(journal.removed(0, 2), 0u);
  EXPECT_EQ(journal.removed(1, 2), 1u);
  EXPECT_EQ(journal.removed(0, 7), 2u);
  ASSERT_TRUE(journal.startRedo());
  finish();
  EXPECT_EQ(journal.removed(0, 2), 3u);
}

TEST_F(CarveJournalTest, AFullJournalStopsRemovalAndCanStillBeUndone) {
  CarveJournal small(3, 2);
  ASSERT_TRUE(small.beginStroke(0));
  for (std::size_t voxel : {1, 2, 3}) ASSERT_TRUE(small.erase(writer, 0, voxel, 0));
  EXPECT_TRUE(small.full());
  EXPECT_FALSE(small.erase(writer, 0, 4, 0));
  EXPECT_TRUE(isBack(4)) << "nothing is removed that could not be put back";
  ASSERT_TRUE(small.startUndo());
  while (small.step(writer, 100)) {
  }
  EXPECT_EQ(hash(), volumeSha256(start));
  ASSERT_TRUE(small.beginStroke(0));
  EXPECT_FALSE(small.full()) << "an undone stroke's room is used again";
}

TEST_F(CarveJournalTest, StrokesCanBeUsedUp) {
  CarveJournal small(100, 2);
  ASSERT_TRUE(small.beginStroke(0));
  ASSERT_TRUE(small.beginStroke(1));
  EXPECT_TRUE(small.full());
  EXPECT_FALSE(small.beginStroke(0));
}

TEST_F(CarveJournalTest, AnEmptyStrokeIsUndoneToo) {
  stroke(0, {1});
  stroke(0, {});
  ASSERT_TRUE(journal.startUndo());
  finish();
  EXPECT_TRUE(isAir(1));
  ASSERT_TRUE(journal.startUndo());
  finish();
  EXPECT_TRUE(isBack(1));
}

TEST_F(CarveJournalTest, UndoMarksTheBricksSoThatTheViewFollows) {
  Volume copy = start;
  std::vector<VoxelBox> boxes;
  stroke(0, {0, start.geometry.indexOf(19, 19, 19)});
  grid.copyChanges(copy, boxes);
  EXPECT_EQ(copy.hu[0], kAirHu);
  boxes.clear();
  ASSERT_TRUE(journal.startUndo());
  finish();
  grid.copyChanges(copy, boxes);
  EXPECT_EQ(boxes.size(), 2u);
  EXPECT_EQ(volumeSha256(copy), volumeSha256(start));
}

}  // namespace
}  // namespace trephine
