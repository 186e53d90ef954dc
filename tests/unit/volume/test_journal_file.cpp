#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <random>
#include <thread>

#include "carve_bench.h"
#include "carve_model.h"
#include "file_size_limit.h"
#include "volume/journal_file.h"

namespace trephine {
namespace {

using test::CarveBench;
using test::CarveModel;

class JournalFileTest : public ::testing::Test {
 protected:
  JournalFileTest() {
    folder =
        std::filesystem::temp_directory_path() / ("trephine-journal-" + std::to_string(::getpid()));
    std::filesystem::create_directory(folder);
  }
  ~JournalFileTest() override { std::filesystem::remove_all(folder); }

  std::filesystem::path folder;
};

TEST_F(JournalFileTest, AFolderThatIsNotThereIsRefused) {
  const auto journal_file = JournalFile::create(folder / "none");
  ASSERT_FALSE(journal_file);
  EXPECT_EQ(journal_file.error().code.str(), "CANNOT_WRITE");
  EXPECT_FALSE(journal_file.error().next.empty());
}

TEST_F(JournalFileTest, NoNameAppearsInTheFolder) {
  CarveBench bench({20, 20, 20}, 16, 10, 10);
  bench.keepOnDisk(folder);
  ASSERT_TRUE(bench.journal.beginStroke(0, {}));
  for (std::size_t voxel = 0; voxel < 500; ++voxel) ASSERT_TRUE(bench.erase(0, voxel));
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST_F(JournalFileTest, WhatWasSavedMakesRoomInTheRing) {
  CarveBench bench({20, 20, 20}, 16, 10, 10);
  bench.keepOnDisk(folder);
  ASSERT_TRUE(bench.journal.beginStroke(0, {}));
  ASSERT_TRUE(bench.journal.hasRoom(16));
  for (std::size_t voxel = 0; voxel < 10; ++voxel) {
    ASSERT_TRUE(bench.journal.erase(bench.writer, 0, voxel, 0));
  }
  EXPECT_FALSE(bench.journal.hasRoom(16));
  EXPECT_TRUE(bench.journal.hasRoom(6));
  bench.service();
  EXPECT_TRUE(bench.journal.hasRoom(16));
  for (std::size_t voxel = 10; voxel < 24; ++voxel) {
    ASSERT_TRUE(bench.journal.erase(bench.writer, 0, voxel, 0));
  }
  bench.service();
  EXPECT_TRUE(bench.journal.hasRoom(16)) << "one service saves over the ring's end";
  EXPECT_FALSE(bench.journal.full());
}

TEST_F(JournalFileTest, AJobWaitsForWhatIsOnDisk) {
  CarveBench bench({20, 20, 20}, 16, 10, 10);
  bench.keepOnDisk(folder);
  ASSERT_TRUE(bench.journal.beginStroke(0, {}));
  for (std::size_t voxel = 0; voxel < 100; ++voxel) ASSERT_TRUE(bench.erase(0, voxel));
  ASSERT_TRUE(bench.journal.startUndo({}));
  // 8 visits a step: the ring holds two steps' worth.
  EXPECT_TRUE(bench.journal.canStep(1));
  EXPECT_FALSE(bench.journal.canStep(3)) << "a slice is all there or not at all";
  bench.service();
  EXPECT_TRUE(bench.journal.canStep(3));
  bench.finish(3);
  EXPECT_EQ(bench.hash(), bench.startHash());
}

TEST_F(JournalFileTest, AStepThatWasNotAllowedDoesNothing) {
  CarveBench bench({20, 20, 20}, 16, 10, 10);
  bench.keepOnDisk(folder);
  ASSERT_TRUE(bench.journal.beginStroke(0, {}));
  for (std::size_t voxel = 0; voxel < 100; ++voxel) ASSERT_TRUE(bench.erase(0, voxel));
  ASSERT_TRUE(bench.journal.startUndo({}));
  const std::string before = bench.hash();
  for (int tick = 0; tick < 5; ++tick) {
    EXPECT_FALSE(bench.journal.canStep(10));
    EXPECT_TRUE(bench.journal.step(bench.writer, 10));
  }
  EXPECT_EQ(bench.hash(), before);
  bench.finish(10);
  EXPECT_EQ(bench.hash(), bench.startHash());
}

TEST_F(JournalFileTest, AFullDiskIsSaidOnceAndEveryWayBackStillWorks) {
  CarveBench bench({20, 20, 20}, 256, 10, 10);
  bench.keepOnDisk(folder);
  ASSERT_TRUE(bench.journal.beginStroke(0, {}));
  int errors = 0;
  std::size_t voxel = 0;
  {
    const test::FileSizeLimit disk(4000 + 3);  // 500 entries and less than half of one
    for (; voxel < 3000 && bench.journal.hasRoom(1); ++voxel) {
      ASSERT_TRUE(bench.journal.erase(bench.writer, 0, voxel, 0));
      if (voxel == 300) bench.mark();
      if (voxel % 50 != 49) continue;
      const Status status = bench.journal_file->service(bench.journal);
      if (status.ok()) continue;
      ++errors;
      EXPECT_EQ(status.error().code.str(), "CANNOT_WRITE");
      EXPECT_EQ(status.error().where, folder.string());
      EXPECT_FALSE(status.error().next.empty());
    }
  }
  EXPECT_EQ(errors, 1);
  EXPECT_EQ(bench.journal.entryCount(), 500u + 256u) << "the journal filled up and removal stopped";
  EXPECT_TRUE(bench.journal.full());
  bench.mark();
  const std::string when_full = bench.hash();
  ASSERT_TRUE(bench.rewind(1));
  EXPECT_TRUE(bench.isAir(299) && bench.isBack(301));
  ASSERT_TRUE(bench.undo());
  EXPECT_EQ(bench.hash(), bench.startHash());
  ASSERT_TRUE(bench.redo());
  EXPECT_TRUE(bench.isAir(299) && bench.isBack(301));
  ASSERT_TRUE(bench.rewind(2)) << "a way that begins on disk and ends in the ring";
  EXPECT_EQ(bench.hash(), when_full);
}

TEST_F(JournalFileTest, AReadThatFailsIsSaidOnceAndTriedAgain) {
  CarveBench bench({20, 20, 20}, 16, 10, 10);
  bench.keepOnDisk(folder);
  auto empty = JournalFile::create(folder);
  ASSERT_TRUE(empty);
  ASSERT_TRUE(bench.journal.beginStroke(0, {}));
  for (std::size_t voxel = 0; voxel < 100; ++voxel) ASSERT_TRUE(bench.erase(0, voxel));
  bench.service();
  ASSERT_TRUE(bench.journal.startUndo({}));
  ASSERT_FALSE(bench.journal.canStep(10));
  const Status status = (*empty)->service(bench.journal);  // a file that lacks the entries
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code.str(), "CANNOT_READ");
  EXPECT_TRUE((*empty)->service(bench.journal).ok());
  EXPECT_FALSE(bench.journal.canStep(10));
  bench.finish(10);
  EXPECT_EQ(bench.hash(), bench.startHash());
}

// Ten minutes, 600 voxels a second, in a ring of 4096 voxels: several loads for one way.
TEST_F(JournalFileTest, TenMinutesOfDrillingCanBeRewoundToAnySecond) {
  CarveBench bench({80, 80, 80}, 4096, 700, 600);
  bench.keepOnDisk(folder);
  const std::size_t ram = bench.journal.ramBytes();
  std::vector<std::size_t> order(bench.start.hu.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  std::size_t next = 0;
  for (int second = 0; second < 600; ++second) {
    ASSERT_TRUE(bench.journal.beginStroke(second % 2, {}));
    for (int n = 0; n < 600; ++n) ASSERT_TRUE(bench.erase(second % 2, order[next++]));
    bench.journal.endStroke(second % 2);
    bench.mark();
  }
  EXPECT_GT(bench.journal.entryCount(), 2 * CarveLog::kLoadEntries);
  const std::string at_end = bench.hash();
  for (std::size_t second : {599, 0, 600, 300, 1, 450, 600, 0}) {
    ASSERT_TRUE(bench.rewind(second));
    Volume expected = bench.start;
    for (std::size_t i = 0; i < second * 600; ++i) expected.hu[order[i]] = kAirHu;
    ASSERT_EQ(bench.hash(), volumeSha256(expected)) << second;
  }
  ASSERT_TRUE(bench.rewind(600));
  EXPECT_EQ(bench.hash(), at_end);
  for (int n = 0; n < 100; ++n) ASSERT_TRUE(bench.undo());
  ASSERT_TRUE(bench.journal.startReset({}));
  bench.finish(300'000);  // a slice is never more than one load
  EXPECT_EQ(bench.hash(), bench.startHash());
  EXPECT_EQ(bench.journal.ramBytes(), ram);
}

// A random history of both kinds of journal against the plain model, step by step.
class RandomHistory : public JournalFileTest, public ::testing::WithParamInterface<int> {
 protected:
  void compare(const CarveBench& bench, const CarveModel& model) {
    ASSERT_EQ(bench.grid.snapshot().hu, model.now.hu);
    ASSERT_EQ(bench.credits, model.now.credits);
    ASSERT_EQ(bench.journal.canUndo(), !model.now.standing.empty());
    ASSERT_EQ(bench.journal.canRedo(), !model.undone.empty());
    for (int arm = 0; arm < kMaxArms; ++arm) {
      for (int c = 0; c < kMaxTissues; ++c) {
        const auto found = model.now.removed.find({arm, c});
        ASSERT_EQ(bench.journal.removed(arm, c),
                  found == model.now.removed.end() ? 0 : found->second);
      }
    }
  }

  void removeSome(CarveBench& bench, CarveModel& model) {
    const int arm = below(3);
    if (!model.open.contains(arm) || below(3) == 0) {
      ASSERT_TRUE(bench.journal.beginStroke(arm, bench.credits));
      model.begin(arm);
    }
    const int count = below(4) == 0 ? below(200) : below(12);
    for (int n = 0; n < count; ++n) {
      const std::size_t voxel = random() % bench.start.hu.size();
      const int tissue_class = below(kMaxTissues);
      ASSERT_TRUE(bench.erase(arm, voxel, tissue_class));
      model.erase(arm, voxel, tissue_class);
    }
    bench.credits[std::size_t(arm)] = model.now.credits[std::size_t(arm)] = below(1000) / 10.0;
    if (below(2) == 0) {
      bench.journal.endStroke(arm);
      model.end(arm);
    }
  }

  int below(int limit) { return int(random() % std::size_t(limit)); }

  std::mt19937_64 random{std::uint64_t(GetParam())};
};

TEST_P(RandomHistory, EverySecondComesBackExactly) {
  const bool on_disk = GetParam() % 2 == 1;
  CarveBench bench({16, 16, 16}, on_disk ? 64 : 1 << 20, 2000, 400);
  if (on_disk) bench.keepOnDisk(folder);
  CarveModel model(bench.start);
  for (int n = 0; n < 1500; ++n) {
    const int what = below(12);
    if (what < 5) {
      removeSome(bench, model);
    } else if (what < 7) {
      ASSERT_EQ(bench.undo(), !model.now.standing.empty());
      if (!model.now.standing.empty()) model.undo();
    } else if (what == 7) {
      ASSERT_EQ(bench.redo(), !model.undone.empty());
      if (!model.undone.empty()) model.redo();
    } else if (what == 8) {
      const std::size_t second = random() % model.marks.size();
      if (bench.rewind(second)) model.rewind(second);
    } else if (model.marks.size() <= 400) {
      bench.mark();
      model.mark();
    }
    compare(bench, model);
    if (HasFatalFailure()) FAIL() << "at step " << n;
  }
  ASSERT_GT(bench.journal.seconds(), 100u);
  for (std::size_t n = 0; n < 2 * bench.journal.seconds(); ++n) {
    const bool in_order = n < bench.journal.seconds();
    const std::size_t second = in_order ? n : random() % bench.journal.seconds();
    if (bench.rewind(second)) model.rewind(second);
    compare(bench, model);
    if (HasFatalFailure()) FAIL() << "at second " << second;
    if (below(3) == 0 && bench.undo()) model.undo();
  }
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutAFile, RandomHistory, ::testing::Range(0, 8));

TEST_F(JournalFileTest, TheRecorderBesideTheHapticThreadLosesNothing) {
  CarveBench bench({40, 40, 40}, 256, 5000, 1000);
  bench.keepOnDisk(folder);
  std::atomic<bool> done{false};
  bool service_failed = false;
  std::thread recorder([&] {
    while (!done) {
      if (!bench.journal_file->service(bench.journal).ok()) service_failed = true;
      std::this_thread::yield();
    }
  });
  CarveModel model(bench.start);
  std::mt19937_64 random(11);
  const auto finish = [&] {
    while (bench.journal.busy()) {
      if (bench.journal.canStep(50)) {
        bench.journal.step(bench.writer, 50);
      } else {
        std::this_thread::yield();
      }
    }
  };
  for (int round = 0; round < 60; ++round) {
    for (int arm = 0; arm < 2; ++arm) {
      ASSERT_TRUE(bench.journal.beginStroke(arm, {}));
      model.begin(arm);
    }
    for (int n = 0; n < 1500; ++n) {
      const std::size_t voxel = random() % bench.start.hu.size();
      while (!bench.journal.hasRoom(1)) std::this_thread::yield();
      ASSERT_TRUE(bench.journal.erase(bench.writer, n % 2, voxel, n % 16));
      model.erase(n % 2, voxel, n % 16);
    }
    bench.mark();
    model.mark();
    if (round % 2 == 0) {
      ASSERT_TRUE(bench.journal.startUndo({}));
      finish();
      model.undo();
    }
    if (round % 3 == 0) {
      const std::size_t second = random() % model.marks.size();
      if (bench.journal.startRewind(second, {})) {
        finish();
        model.rewind(second);
      }
    }
    ASSERT_EQ(bench.grid.snapshot().hu, model.now.hu) << round;
  }
  ASSERT_TRUE(bench.journal.startReset({}));
  finish();
  done = true;
  recorder.join();
  EXPECT_FALSE(service_failed);
  EXPECT_EQ(bench.hash(), bench.startHash());
  EXPECT_GT(bench.journal.entryCount(), 20 * 256u);
}

}  // namespace
}  // namespace trephine
