// What was removed, so that it can be put back: a preallocated list of voxels with their old HU,
// grouped into strokes. A stroke belongs to one arm; strokes of two arms may interleave, and since
// an erased voxel cannot be erased again, each can be undone without touching the other.
//
// Used by the holder of the write token only. Nothing here allocates after construction.
#pragma once

#include <cstdint>
#include <vector>

#include "volume/grid.h"

namespace trephine {

constexpr int kMaxClasses = 16;  // tissue classes that a journal, a table and a recording count
constexpr int kMaxArms = 4;

class CarveJournal {
 public:
  struct Entry {
    std::uint32_t voxel;
    std::int16_t old_hu;
    std::uint16_t stroke;
  };
  struct Stroke {
    std::uint32_t first = 0;  // entries [first, end) hold this stroke's, perhaps among others'
    std::uint32_t end = 0;
    std::int32_t arm = 0;
    bool undone = false;
    std::uint32_t removed[kMaxClasses] = {};  // voxels by tissue class when they were removed
  };

  // `max_voxels` entries of 8 bytes. A grid of over 2^32 voxels is not supported.
  CarveJournal(std::size_t max_voxels, std::size_t max_strokes);

  // A new stroke of `arm`; drops whatever could still be redone. False when strokes are used up.
  bool beginStroke(int arm);
  void endStroke(int arm);
  bool inStroke(int arm) const { return open_[arm] >= 0; }

  // Sets the voxel to air in the arm's open stroke; one that is air already is left and not
  // counted. False, and nothing done, when the journal is full: removal stops, and the caller says
  // so.
  bool erase(Grid::Writer& writer, int arm, std::size_t voxel, int tissue_class);
  bool full() const {
    const bool can_drop = stroke_count_ > 0 && strokes_[stroke_count_ - 1].undone;
    return !can_drop && (entry_count_ == entries_.size() || stroke_count_ == strokes_.size());
  }

  // Undo, redo and reset run in slices: start one, then step it until it is done. Starting fails
  // while another runs or when there is nothing to do. Open strokes are ended first.
  bool startUndo();                    // the last stroke that stands
  bool startUndo(std::size_t stroke);  // any stroke that stands
  bool startRedo();                    // the stroke undone last
  bool startReset();                   // everything; nothing can be redone after it
  // Restores or erases up to `max_voxels` voxels (visits at most 8 times as many entries); true
  // while there is more to do.
  bool step(Grid::Writer& writer, std::size_t max_voxels);
  bool busy() const { return job_ != Job::none; }

  std::size_t strokeCount() const { return stroke_count_; }
  const Stroke& stroke(std::size_t i) const { return strokes_[i]; }
  std::size_t entryCount() const { return entry_count_; }
  // Voxels of `arm` and `tissue_class` that are removed now, undone strokes not counted.
  std::uint64_t removed(int arm, int tissue_class) const;

 private:
  enum class Job { none, undo, redo, reset };

  void dropUndone();
  void finishJob();

  std::vector<Entry> entries_;
  std::vector<Stroke> strokes_;
  std::vector<std::uint16_t> undone_;  // stroke numbers in the order they were undone
  std::size_t entry_count_ = 0;
  std::size_t stroke_count_ = 0;
  std::size_t undone_count_ = 0;
  std::int32_t open_[kMaxArms] = {-1, -1, -1, -1};
  std::uint64_t removed_[kMaxArms][kMaxClasses] = {};
  Job job_ = Job::none;
  std::size_t job_stroke_ = 0;
  std::size_t cursor_ = 0;
};

}  // namespace trephine
