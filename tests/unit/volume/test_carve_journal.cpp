#include "carve_bench.h"

namespace trephine {
namespace {

using Credits = CarveJournal::Credits;

class CarveJournalTest : public ::testing::Test, protected test::CarveBench {
 protected:
  CarveJournalTest() : CarveBench({20, 20, 20}, 1000, 300, 50) {}
};

TEST_F(CarveJournalTest, ErasesOnlyInsideAStroke) {
  EXPECT_FALSE(erase(0, 5));
  EXPECT_EQ(hash(), startHash());
  ASSERT_TRUE(journal.beginStroke(0, credits));
  EXPECT_TRUE(journal.inStroke(0));
  EXPECT_FALSE(journal.inStroke(1));
  EXPECT_TRUE(erase(0, 5));
  EXPECT_TRUE(isAir(5));
  journal.endStroke(0);
  EXPECT_FALSE(journal.inStroke(0));
  EXPECT_FALSE(erase(0, 6));
  EXPECT_TRUE(isBack(6));
}

TEST_F(CarveJournalTest, ErasesNoMoreThanWasGranted) {
  ASSERT_TRUE(journal.beginStroke(0, credits));
  EXPECT_FALSE(journal.erase(writer, 0, 1, 0)) << "nobody asked for room";
  ASSERT_TRUE(journal.hasRoom(2));
  EXPECT_TRUE(journal.erase(writer, 0, 1, 0));
  EXPECT_TRUE(journal.erase(writer, 0, 1, 0)) << "air already: needs no room";
  EXPECT_TRUE(journal.erase(writer, 0, 2, 0));
  EXPECT_FALSE(journal.erase(writer, 0, 3, 0));
  EXPECT_TRUE(isBack(3));
  ASSERT_TRUE(journal.hasRoom(5));
  EXPECT_FALSE(journal.hasRoom(5000));
  EXPECT_FALSE(journal.erase(writer, 0, 3, 0)) << "a no takes back the yes before it";
}

TEST(CarveEntry, KeepsEveryTissueThatASetMayHoldApartForEveryArm) {
  for (int arm = 0; arm < kMaxArms; ++arm) {
    for (int tissue_class = 0; tissue_class < kMaxTissues; ++tissue_class) {
      const std::uint32_t all = (1u << kMaxArms) - 1, others = all & ~(1u << arm);
      const CarveEntry alone{7, 400, CarveEntry::makeTag(arm, tissue_class)};
      const CarveEntry shared{7, 400, CarveEntry::makeTag(arm, tissue_class, others)};
      EXPECT_EQ(alone.payers(), 1u << arm);
      EXPECT_EQ(shared.payers(), all);
      for (const CarveEntry& entry : {alone, shared}) {
        EXPECT_EQ(entry.tissueClass(), tissue_class);
        EXPECT_EQ(entry.arm(), arm);
      }
    }
  }
}

TEST_F(CarveJournalTest, UndoPutsTheLastStrokeBackAndRedoTakesItAgain) {
  stroke(0, {1, 2, 3});
  const std::string after_first = hash();
  stroke(0, {10, 11});
  const std::string after_second = hash();
  EXPECT_TRUE(journal.canUndo());
  EXPECT_FALSE(journal.canRedo());
  ASSERT_TRUE(undo());
  EXPECT_EQ(hash(), after_first);
  ASSERT_TRUE(undo());
  EXPECT_EQ(hash(), startHash());
  EXPECT_FALSE(journal.canUndo());
  EXPECT_FALSE(undo());
  ASSERT_TRUE(redo());
  EXPECT_EQ(hash(), after_first);
  ASSERT_TRUE(redo());
  EXPECT_EQ(hash(), after_second);
  EXPECT_FALSE(journal.canRedo());
  EXPECT_FALSE(redo());
}

TEST_F(CarveJournalTest, StrokesOfTwoArmsThatInterleaveAreUndoneApart) {
  ASSERT_TRUE(journal.beginStroke(0, credits));
  carve(0, {1});
  ASSERT_TRUE(journal.beginStroke(1, credits));
  carve(1, {100});
  carve(0, {2});
  carve(1, {101, 102});
  carve(0, {3});
  ASSERT_TRUE(undo());
  for (std::size_t voxel : {1, 2, 3}) EXPECT_TRUE(isAir(voxel));
  for (std::size_t voxel : {100, 101, 102}) EXPECT_TRUE(isBack(voxel));
  EXPECT_EQ(journal.removed(0, 0), 3u);
  EXPECT_EQ(journal.removed(1, 0), 0u);
  ASSERT_TRUE(undo());
  EXPECT_EQ(hash(), startHash());
  ASSERT_TRUE(redo());
  for (std::size_t voxel : {1, 2, 3}) EXPECT_TRUE(isAir(voxel));
  for (std::size_t voxel : {100, 101, 102}) EXPECT_TRUE(isBack(voxel));
  ASSERT_TRUE(redo());
  for (std::size_t voxel : {1, 2, 3, 100, 101, 102}) EXPECT_TRUE(isAir(voxel));
  EXPECT_EQ(journal.removed(1, 0), 3u);
}

TEST_F(CarveJournalTest, RemovalGoesOnAfterAnInterleavedStrokeWasUndone) {
  ASSERT_TRUE(journal.beginStroke(0, credits));
  ASSERT_TRUE(journal.beginStroke(1, credits));
  carve(0, {1});
  carve(1, {50});
  carve(0, {2});
  ASSERT_TRUE(undo());
  stroke(1, {50, 60});
  ASSERT_TRUE(undo());
  EXPECT_TRUE(isBack(60) && isBack(50) && isAir(1) && isAir(2));
  ASSERT_TRUE(redo());
  EXPECT_TRUE(isAir(60) && isAir(50));
  ASSERT_TRUE(undo());
  ASSERT_TRUE(undo());
  EXPECT_EQ(hash(), startHash());
}

TEST_F(CarveJournalTest, AVoxelThatCameBackCanBeErasedByALaterStroke) {
  stroke(0, {3});
  stroke(0, {1, 2});
  ASSERT_TRUE(undo());
  stroke(1, {2, 4});
  EXPECT_TRUE(isBack(1) && isAir(2) && isAir(3) && isAir(4));
  ASSERT_TRUE(undo());
  EXPECT_TRUE(isBack(2) && isBack(4) && isAir(3));
  ASSERT_TRUE(reset());
  EXPECT_EQ(hash(), startHash());
}

TEST_F(CarveJournalTest, AnErasedVoxelIsNotErasedTwice) {
  stroke(0, {1, 2});
  stroke(1, {2, 3});
  EXPECT_EQ(journal.removed(1, 0), 1u);
  EXPECT_EQ(journal.entryCount(), 3u);
  ASSERT_TRUE(undo());
  EXPECT_TRUE(isAir(2) && isBack(3));
  ASSERT_TRUE(undo());
  EXPECT_EQ(hash(), startHash());
}

TEST_F(CarveJournalTest, ANewStrokeDropsWhatCouldBeRedone) {
  stroke(0, {1, 2});
  stroke(0, {3});
  ASSERT_TRUE(undo());
  stroke(0, {4});
  EXPECT_FALSE(journal.canRedo());
  EXPECT_FALSE(redo());
  EXPECT_TRUE(isBack(3) && isAir(4));
}

TEST_F(CarveJournalTest, ARewindDropsWhatCouldBeRedone) {
  stroke(0, {1, 2});
  mark();
  stroke(0, {3});
  ASSERT_TRUE(undo());
  stroke(0, {4});
  ASSERT_TRUE(undo());
  ASSERT_TRUE(journal.canRedo());
  ASSERT_TRUE(rewind(0));
  EXPECT_FALSE(journal.canRedo());
  EXPECT_FALSE(redo());
  EXPECT_EQ(hash(), startHash());
}

TEST_F(CarveJournalTest, ResetRestoresTheExactVolumeAndTheCounts) {
  EXPECT_FALSE(reset()) << "there is nothing to reset";
  for (std::size_t v = 0; v < 19; ++v) stroke(int(v) % 2, {v * 300, v * 300 + 1}, int(v % 4));
  ASSERT_TRUE(undo());
  ASSERT_TRUE(reset());
  EXPECT_EQ(hash(), startHash());
  EXPECT_FALSE(undo());
  EXPECT_FALSE(redo());
  for (int arm = 0; arm < kMaxArms; ++arm) {
    for (int c = 0; c < kMaxTissues; ++c) EXPECT_EQ(journal.removed(arm, c), 0u);
  }
  EXPECT_FALSE(reset());
}

TEST_F(CarveJournalTest, ResetTakesBackWorkThatRemovedNothingYet) {
  credits = {0.5, 0, 0, 0};
  ASSERT_TRUE(reset());
  EXPECT_EQ(credits, Credits{});
}

TEST_F(CarveJournalTest, WorksInSlicesAndRefusesOtherWorkMeanwhile) {
  mark();
  ASSERT_TRUE(journal.beginStroke(0, credits));
  for (std::size_t voxel = 0; voxel < 100; ++voxel) carve(0, {voxel});
  ASSERT_TRUE(journal.startUndo(credits));
  EXPECT_FALSE(journal.inStroke(0)) << "an open stroke is ended first";
  EXPECT_TRUE(journal.step(writer, 30));
  EXPECT_TRUE(isBack(99) && isBack(70) && isAir(69));
  EXPECT_EQ(journal.removed(0, 0), 70u) << "counts follow the voxels";
  EXPECT_TRUE(journal.busy());
  EXPECT_FALSE(journal.startUndo(credits));
  EXPECT_FALSE(journal.startRedo(credits));
  EXPECT_FALSE(journal.startRewind(0, credits));
  EXPECT_FALSE(journal.startReset(credits));
  EXPECT_FALSE(journal.beginStroke(0, credits));
  EXPECT_FALSE(erase(0, 500));
  EXPECT_EQ(finish(30), 3);
  EXPECT_FALSE(journal.busy());
  EXPECT_FALSE(journal.step(writer, 30));
  EXPECT_EQ(hash(), startHash());
}

TEST_F(CarveJournalTest, AStepVisitsAtMostEightTimesItsVoxels) {
  ASSERT_TRUE(journal.beginStroke(1, credits));
  ASSERT_TRUE(journal.beginStroke(0, credits));
  carve(0, {0});
  for (std::size_t voxel = 1; voxel <= 200; ++voxel) carve(1, {voxel});
  carve(0, {201});
  ASSERT_TRUE(journal.startUndo(credits));
  // 202 entries lie between its first and last; a step of 5 visits 40 of them.
  EXPECT_EQ(finish(5), 6);
  EXPECT_TRUE(isBack(0) && isBack(201) && isAir(100));
}

TEST_F(CarveJournalTest, CountsWhatIsRemovedNowByArmAndClass) {
  stroke(1, {4}, 2);
  stroke(3, {5, 6}, 15);
  stroke(0, {1, 2, 3}, 2);
  EXPECT_EQ(journal.removed(0, 2), 3u);
  EXPECT_EQ(journal.removed(1, 2), 1u);
  EXPECT_EQ(journal.removed(3, 15), 2u);
  ASSERT_TRUE(undo());
  EXPECT_EQ(journal.removed(0, 2), 0u);
  EXPECT_EQ(journal.removed(1, 2), 1u);
  EXPECT_EQ(journal.removed(3, 15), 2u);
  ASSERT_TRUE(redo());
  EXPECT_EQ(journal.removed(0, 2), 3u);
}

TEST_F(CarveJournalTest, UndoGivesBackTheCreditOfItsArmAlone) {
  credits = {0.1, 0.2, 0.3, 0.4};
  stroke(1, {1});
  credits = {1, 2, 3, 4};
  ASSERT_TRUE(undo());
  EXPECT_EQ(credits, (Credits{1, 0.2, 3, 4}));
  ASSERT_TRUE(redo());
  EXPECT_EQ(credits, (Credits{1, 0.2, 3, 4})) << "no more than before";
}

// Else undo and redo in turn would fill it without work.
TEST_F(CarveJournalTest, RedoSpendsTheCreditAgain) {
  credits = {0.1, 2.0, 0.3, 0.4};
  stroke(1, {1});
  credits = {1, 0.5, 3, 4};
  ASSERT_TRUE(undo());
  EXPECT_EQ(credits[1], 2.0);
  ASSERT_TRUE(redo());
  EXPECT_EQ(credits, (Credits{1, 0.5, 3, 4}));
}

TEST_F(CarveJournalTest, RewindGivesBackAllCredits) {
  credits = {0.1, 0.2, 0.3, 0.4};
  mark();
  credits = {1, 2, 3, 4};
  ASSERT_TRUE(rewind(1)) << "credits alone are a reason to go back";
  EXPECT_EQ(credits, (Credits{0.1, 0.2, 0.3, 0.4}));
  EXPECT_FALSE(rewind(1)) << "there already";
}

TEST_F(CarveJournalTest, RewindGoesToAnySecondBackwardsAndForwards) {
  std::vector<std::string> hashes = {hash()};
  for (std::size_t second = 1; second <= 6; ++second) {
    stroke(0, {second * 10, second * 10 + 1});
    mark();
    EXPECT_EQ(journal.seconds(), second);
    hashes.push_back(hash());
  }
  for (std::size_t second : {3, 5, 0, 6, 1, 2}) {
    ASSERT_TRUE(rewind(second));
    EXPECT_EQ(hash(), hashes[second]) << second;
    EXPECT_EQ(journal.removed(0, 0), second * 2);
  }
  EXPECT_FALSE(rewind(7)) << "no such second";
}

TEST_F(CarveJournalTest, ARewindCanBeRewoundAfterRemovalWentOnFromThere) {
  stroke(0, {1, 2});
  mark();
  stroke(0, {3, 4});
  mark();
  const std::string before = hash();
  ASSERT_TRUE(rewind(1));
  stroke(0, {4, 5});
  mark();
  const std::string after = hash();
  ASSERT_TRUE(rewind(2));
  EXPECT_EQ(hash(), before);
  ASSERT_TRUE(rewind(3));
  EXPECT_EQ(hash(), after);
  ASSERT_TRUE(undo());
  EXPECT_TRUE(isAir(1) && isAir(2) && isBack(3) && isBack(4) && isBack(5));
  ASSERT_TRUE(undo());
  EXPECT_EQ(hash(), startHash());
}

TEST_F(CarveJournalTest, ARewindIntoAStrokeCutsItThere) {
  ASSERT_TRUE(journal.beginStroke(0, credits));
  carve(0, {1, 2});
  mark();
  carve(0, {3, 4});
  ASSERT_TRUE(rewind(1));
  EXPECT_FALSE(journal.inStroke(0));
  EXPECT_TRUE(isAir(1) && isAir(2) && isBack(3) && isBack(4));
  stroke(1, {3});
  ASSERT_TRUE(undo());
  ASSERT_TRUE(undo());
  EXPECT_EQ(hash(), startHash());
  ASSERT_TRUE(redo());
  EXPECT_TRUE(isAir(1) && isAir(2) && isBack(3) && isBack(4)) << "what was cut stays away";
}

TEST_F(CarveJournalTest, ARewindCutsAStrokeDeepBelowOthers) {
  ASSERT_TRUE(journal.beginStroke(0, credits));
  carve(0, {1});
  for (std::size_t n = 0; n < 20; ++n) {
    stroke(1, {100 + n});
    carve(0, {200 + n});
  }
  mark();
  const std::string at_mark = hash();
  carve(0, {300, 301});
  stroke(1, {302});
  ASSERT_TRUE(rewind(1));
  EXPECT_EQ(hash(), at_mark);
  for (std::size_t n = 20; n-- > 0;) {
    ASSERT_TRUE(undo());
    EXPECT_TRUE(isBack(100 + n) && isAir(200 + n));
  }
  ASSERT_TRUE(undo());
  EXPECT_EQ(hash(), startHash());
  EXPECT_FALSE(undo());
}

TEST_F(CarveJournalTest, AStrokeCutBeforeItsFirstVoxelIsUndoneAsAnEmptyOne) {
  stroke(0, {1});
  ASSERT_TRUE(undo());
  ASSERT_TRUE(journal.beginStroke(0, credits));
  ASSERT_TRUE(journal.beginStroke(1, credits));
  mark();
  carve(1, {2});
  carve(0, {3});
  ASSERT_TRUE(rewind(1));
  EXPECT_EQ(hash(), startHash());
  EXPECT_TRUE(undo());
  EXPECT_TRUE(undo());
  EXPECT_FALSE(undo());
  EXPECT_EQ(hash(), startHash());
}

TEST_F(CarveJournalTest, AMarkDuringAJobStandsForItsEnd) {
  credits = {1, 0, 0, 0};
  stroke(0, {1, 2, 3, 4, 5, 6});
  credits = {9, 0, 0, 0};
  mark();
  ASSERT_TRUE(journal.startUndo(credits));
  journal.step(writer, 2);
  journal.mark({7, 7, 7, 7});
  EXPECT_EQ(journal.seconds(), 2u) << "numbered at once";
  finish(2);
  ASSERT_TRUE(rewind(1));
  EXPECT_TRUE(isAir(1) && isAir(6));
  ASSERT_TRUE(rewind(2));
  EXPECT_EQ(hash(), startHash());
  EXPECT_EQ(credits, (Credits{1, 0, 0, 0}));
  EXPECT_FALSE(journal.canUndo());
}

TEST_F(CarveJournalTest, MarksStopWhenTheSecondsAreUsedUp) {
  for (std::size_t n = 0; n < 60; ++n) {
    stroke(0, {n});
    mark();
  }
  EXPECT_EQ(journal.seconds(), 50u);
  ASSERT_TRUE(rewind(50));
  EXPECT_TRUE(isAir(49) && isBack(50));
}

TEST_F(CarveJournalTest, GoingBackAndForthNeedsNoRoom) {
  for (std::size_t n = 0; n < 10; ++n) {
    stroke(int(n) % 2, {n * 2, n * 2 + 1});
    mark();
  }
  for (std::size_t n = 0; n < 500; ++n) {
    rewind(n * 7 % 11);
    undo();
    redo();
  }
  EXPECT_EQ(journal.entryCount(), 20u);
  rewind(5);
  const std::string at_five = hash();
  ASSERT_TRUE(reset());
  ASSERT_TRUE(journal.startRewind(5, credits));
  EXPECT_EQ(finish(1), 10) << "the way is no longer than the first time";
  EXPECT_EQ(hash(), at_five);
}

TEST_F(CarveJournalTest, UndoAndRedoOfOneStrokeCanBeRepeatedForEver) {
  test::CarveBench small({20, 20, 20}, 16, 2, 2);
  ASSERT_TRUE(small.journal.beginStroke(0, {}));
  small.carve(0, {1});
  ASSERT_TRUE(small.journal.beginStroke(1, {}));
  small.carve(1, {2});
  small.carve(0, {3});
  for (int n = 0; n < 1000; ++n) {
    ASSERT_TRUE(small.undo() && small.isBack(2) && small.isAir(3)) << n;
    ASSERT_TRUE(small.redo() && small.isAir(2)) << n;
  }
}

TEST_F(CarveJournalTest, WhatWasUndoneLengthensNoLaterWay) {
  stroke(0, {0});
  mark();
  for (std::size_t n = 0; n < 200; ++n) {
    stroke(0, {n + 1, n + 300});
    ASSERT_TRUE(undo());
  }
  ASSERT_TRUE(journal.startReset(credits));
  EXPECT_EQ(finish(1), 1);
}

TEST_F(CarveJournalTest, AFullJournalStopsRemovalAndEveryWayBackStillWorks) {
  test::CarveBench small({20, 20, 20}, 4, 10, 10);
  ASSERT_TRUE(small.journal.beginStroke(0, {}));
  small.carve(0, {1, 2});
  ASSERT_TRUE(small.journal.beginStroke(1, {}));
  small.carve(1, {3});
  small.mark();
  small.carve(0, {4});
  EXPECT_TRUE(small.journal.full());
  EXPECT_FALSE(small.journal.hasRoom(1));
  EXPECT_FALSE(small.journal.erase(small.writer, 0, 5, 0));
  EXPECT_TRUE(small.isBack(5)) << "nothing is removed that could not be put back";
  ASSERT_TRUE(small.undo());
  EXPECT_TRUE(small.isBack(3) && small.isAir(4));
  ASSERT_TRUE(small.redo());
  ASSERT_TRUE(small.rewind(1));
  EXPECT_TRUE(small.isAir(3) && small.isBack(4));
  ASSERT_TRUE(small.reset());
  EXPECT_EQ(small.hash(), small.startHash());
  EXPECT_TRUE(small.journal.full()) << "the log keeps what was, so that it can be reached again";
}

TEST_F(CarveJournalTest, TheRingIsRoundedUpToAPowerOfTwo) {
  CarveJournal journal_of_five(5, 10, 10);
  EXPECT_TRUE(journal_of_five.hasRoom(8));
  EXPECT_FALSE(journal_of_five.hasRoom(9));
}

TEST_F(CarveJournalTest, StrokesCanBeUsedUp) {
  CarveJournal small(100, 2, 10);
  ASSERT_TRUE(small.beginStroke(0, {}));
  EXPECT_FALSE(small.full());
  ASSERT_TRUE(small.beginStroke(1, {}));
  EXPECT_TRUE(small.full());
  EXPECT_FALSE(small.beginStroke(0, {}));
}

TEST_F(CarveJournalTest, AnEmptyStrokeIsUndoneToo) {
  stroke(0, {1});
  stroke(0, {});
  ASSERT_TRUE(undo());
  EXPECT_TRUE(isAir(1));
  ASSERT_TRUE(undo());
  EXPECT_TRUE(isBack(1));
}

TEST_F(CarveJournalTest, UndoMarksTheBricksSoThatTheViewFollows) {
  Volume copy = start;
  std::vector<VoxelBox> boxes;
  stroke(0, {0, start.geometry.indexOf(19, 19, 19)});
  grid.copyChanges(copy, boxes);
  EXPECT_EQ(copy.hu[0], kAirHu);
  boxes.clear();
  ASSERT_TRUE(undo());
  grid.copyChanges(copy, boxes);
  EXPECT_EQ(boxes.size(), 2u);
  EXPECT_EQ(volumeSha256(copy), startHash());
}

}  // namespace
}  // namespace trephine
