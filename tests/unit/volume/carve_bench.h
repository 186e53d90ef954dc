// A grid with its writer, a journal and, where wanted, a file for it, for the tests of removal.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <memory>
#include <string>

#include "volume/carve_journal.h"
#include "volume/journal_file.h"
#include "volumes.h"

namespace trephine::test {

struct CarveBench {
  CarveBench(const Index3& size, std::size_t ring, std::size_t strokes, std::size_t seconds)
      : start(patternVolume(size)), journal(ring, strokes, seconds) {}

  void keepOnDisk(const std::filesystem::path& folder) {
    auto made = JournalFile::create(folder);
    ASSERT_TRUE(made) << made.error().sentence();
    journal_file = std::move(made.value());
  }
  void service() {
    if (!journal_file) return;
    const Status status = journal_file->service(journal);
    ASSERT_TRUE(status) << status.error().sentence();
  }
  // Erases one voxel as a tick does: asks for room first.
  bool erase(int arm, std::size_t voxel, int tissue_class = 0) {
    if (!journal.hasRoom(1)) service();
    return journal.hasRoom(1) && journal.erase(writer, arm, voxel, tissue_class);
  }
  void carve(int arm, std::initializer_list<std::size_t> voxels, int tissue_class = 0) {
    for (std::size_t voxel : voxels) ASSERT_TRUE(erase(arm, voxel, tissue_class)) << voxel;
  }
  void stroke(int arm, std::initializer_list<std::size_t> voxels, int tissue_class = 0) {
    ASSERT_TRUE(journal.beginStroke(arm, credits));
    carve(arm, voxels, tissue_class);
    journal.endStroke(arm);
  }
  // Finishes a job and goes on with its credits; tells how many steps it took.
  int finish(std::size_t voxels_a_step = 1000) {
    int steps = 0;
    while (journal.busy()) {
      if (!journal.canStep(voxels_a_step)) {
        service();
        EXPECT_TRUE(journal.canStep(voxels_a_step)) << "one service brings what is asked for";
        if (!journal.canStep(voxels_a_step)) return steps;
      }
      journal.step(writer, voxels_a_step);
      ++steps;
    }
    credits = journal.credits();
    return steps;
  }
  bool undo() { return journal.startUndo(credits) && finish() > 0; }
  bool redo() { return journal.startRedo(credits) && finish() > 0; }
  bool rewind(std::size_t second) { return journal.startRewind(second, credits) && finish() > 0; }
  bool reset() { return journal.startReset(credits) && finish() > 0; }
  void mark() { journal.mark(credits); }

  bool isAir(std::size_t voxel) const { return grid.hu(voxel) == kAirHu; }
  bool isBack(std::size_t voxel) const { return grid.hu(voxel) == start.hu[voxel]; }
  std::string hash() const { return volumeSha256(grid.snapshot()); }
  std::string startHash() const { return volumeSha256(start); }

  const Volume start;
  Grid grid{start};
  Grid::Writer writer{std::move(*grid.takeWriter())};
  CarveJournal journal;
  CarveJournal::Credits credits{};
  std::unique_ptr<JournalFile> journal_file;
};

}  // namespace trephine::test
