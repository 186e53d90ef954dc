// What was removed, and every way back: undo, redo, rewind to any second, reset.
//
// The log holds the voxels that were taken, in order, and only removal adds to it. What people undo
// and take up again makes the past a tree: whoever removes after going back starts a new branch
// there. A place is a point of that tree, and every job is the same: travel from the present place
// to another, putting back on the way up and taking again on the way down. So no job needs room in
// the log, going back and forth costs nothing but the way, and what was left can be reached again.
//
// A stroke belongs to one arm; strokes of several arms may interleave. Undo takes the last stroke
// that stands. Where no other arm's voxels came since its beginning, it is a way back to there;
// else it becomes a branch of its own, which puts back this stroke's voxels alone.
//
// Used by the holder of the grid's write token only (the recorder has log() through JournalFile).
// After construction nothing here allocates, locks, waits or throws. What another thread decides
// (room, entries brought back from disk) comes in through hasRoom() and canStep() alone: all else
// is a function of the calls and of those two answers, so that a recording of them replays bit for
// bit.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/limits.h"
#include "volume/carve_log.h"
#include "volume/grid.h"

namespace trephine {

// A voxel that n arms paid together counts 1/n for each: in twelfths, whole for up to four.
constexpr int kVoxelShares = 12;
static_assert(kMaxArms <= 4);

class CarveJournal {
 public:
  // Work not yet spent on removal, by arm [J]. It goes back with the tissue.
  using Credits = std::array<double, kMaxArms>;

  // `ring_voxels` entries of 8 bytes stay in memory (rounded up to a power of two). A grid of over
  // 2^32 voxels is not supported. Makes mark 0: nothing removed, no credit.
  CarveJournal(std::size_t ring_voxels, std::size_t max_strokes, std::size_t max_seconds);

  // ---- Removal.
  // A new stroke of `arm`; drops whatever could still be redone. False when strokes are used up or
  // a job runs.
  bool beginStroke(int arm, const Credits& now);
  void endStroke(int arm) { open_[arm] = kNone; }
  bool inStroke(int arm) const { return open_[arm] != kNone; }
  // Of two strokes that are open, the greater number is that of the newer: undo takes it first.
  std::uint32_t openStroke(int arm) const { return open_[arm]; }
  // Asked at the start of a tick, before what it may erase: grants that many entries until it is
  // asked again. After a no, nothing can be erased.
  bool hasRoom(std::size_t entries);
  // Sets the voxel to air in the arm's open stroke; one that is air already is left and not
  // counted. False, and nothing done, outside a stroke, during a job or beyond what was granted.
  // It is the arm's alone to undo; `sharers` are other arms, a bit each, that paid for it too.
  bool erase(Grid::Writer& writer, int arm, std::size_t voxel, int tissue_class,
             std::uint32_t sharers = 0);
  // For display: not even one voxel can be removed now, or no stroke can begin.
  bool full() const {
    return !log_.hasRoom(1) || stroke_count_ == strokes_.size() ||
           branch_count_ == branches_.size();
  }

  // ---- Seconds. Called once per second of session time, so that mark n is second n. During a job
  // the mark is numbered at once and stands for the state in which the job ends (`now` is not
  // used). When `max_seconds` are used up, marks stop.
  void mark(const Credits& now);
  std::size_t seconds() const { return mark_count_ - 1; }  // the newest mark

  // ---- Jobs: start one, then step it until it is done. Starting fails while another runs or when
  // there is nothing to do; it ends open strokes. `now` are the credits at the start.
  bool canUndo() const { return top_ != kNone && branch_count_ < branches_.size(); }
  bool canRedo() const { return redo_top_ != kNone; }
  // The last stroke that stands. Its arm's credit becomes what it was when the stroke began.
  bool startUndo(const Credits& now);
  // The stroke undone last. Its arm's credit becomes no more than it was before the undo.
  bool startRedo(const Credits& now);
  // Tissue, counts, credits and the strokes that can be undone become exactly what they were at
  // that mark, before or after the present place; nothing can be redone then. A stroke that was
  // open at the mark is ended there.
  bool startRewind(std::size_t second, const Credits& now);
  bool startReset(const Credits& now) { return startRewind(0, now); }

  // Whether step() with the same argument has all it needs in memory; if not, asks for it, and the
  // caller tries again in a later tick. Always so while the log fits into the ring.
  bool canStep(std::size_t max_voxels);
  // Changes up to `max_voxels` voxels and visits at most 8 times as many entries; true while there
  // is more to do. Does nothing where canStep() would say no. The voxels that it wrote are appended
  // to `changed`, if given.
  bool step(Grid::Writer& writer, std::size_t max_voxels,
            std::vector<std::uint32_t>* changed = nullptr);
  bool busy() const { return busy_; }
  // The credits to go on with after a job.
  const Credits& credits() const { return job_credits_; }

  // Voxels of `arm` and `tissue_class` that are removed now.
  std::uint64_t removed(int arm, int tissue_class) const { return removed_[arm][tissue_class]; }
  // What `arm` paid of all that is removed now, in 1 / kVoxelShares of a voxel.
  std::uint64_t paid(int arm) const { return paid_[arm]; }
  // Voxels ever removed: the log's length. Jobs do not change it.
  std::uint64_t entryCount() const { return log_.size(); }
  std::size_t ramBytes() const;

  // For JournalFile.
  CarveLog& log() { return log_; }

  // The tree, the strokes, the marks, the place and the job, not the entries of the log: these are
  // the volume's. A reader has a log with the same entries and a grid at the same place, which
  // hashOfPlace() tells.
  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive.firstOf(self.branches_, self.branch_count_);
    archive.firstOf(self.strokes_, self.stroke_count_);
    archive.firstOf(self.marks_, self.mark_count_);
    archive(self.settled_marks_, self.here_, self.tip_branch_, self.top_, self.redo_top_);
    archive(self.open_, self.removed_, self.paid_, self.busy_);
    if (self.busy_) {
      archive(self.target_, self.job_top_, self.job_redo_top_, self.job_credits_);
      archive(self.climbing_, self.meet_branch_, self.way_down_);
      archive(self.cursor_, self.limit_, self.stretch_arm_, self.stretch_to_);
    }
    if constexpr (Archive::kReads) {
      if (!self.isWhole()) archive.refuse();
    }
  }
  // Of the log's length, of the entries that the ring holds, and of which of them the grid lacks.
  std::uint64_t hashOfPlace(const Grid& grid) const;

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t(0);

  // After the entries of `branch` below `entry`.
  struct Place {
    std::uint32_t branch = 0;
    std::uint64_t entry = 0;
    friend bool operator==(const Place&, const Place&) = default;

    template <class Self, class Archive>
    static void visitState(Self& self, Archive& archive) {
      archive(self.branch, self.entry);
    }
  };
  // Removal: entries from `first` on, in order. Undo of a stroke: the entries of `arm` in
  // [first, end), put back; its only place has the entry `first`.
  struct Branch {
    Place parent;
    std::uint64_t first = 0;
    std::uint64_t end = 0;
    std::int32_t arm = -1;           // -1: removal
    std::uint32_t way_down = kNone;  // the next branch of a job's way down
    bool isUndo() const { return arm >= 0; }

    template <class Self, class Archive>
    static void visitState(Self& self, Archive& archive) {
      archive(self.parent, self.first, self.end);
      archive.within(self.arm, -1, kMaxArms);
      archive(self.way_down);
    }
  };
  struct Stroke {
    std::uint64_t first = 0;  // its entries are those of its arm in [first, end)
    std::uint64_t end = 0;
    std::uint64_t voxels = 0;
    Credits credits{};  // when it began
    double credit_before_undo = 0.0;  // of its arm
    std::int32_t arm = 0;
    std::uint32_t branch = 0;
    std::uint32_t below = kNone;       // the stroke that undo takes next
    std::uint32_t redo_below = kNone;  // the stroke that redo takes next, while this is undone
    Place undone_from{kNone, 0};       // where it was undone last, and where that led
    Place undone_to{kNone, 0};

    template <class Self, class Archive>
    static void visitState(Self& self, Archive& archive) {
      archive(self.first, self.end, self.voxels, self.credits, self.credit_before_undo);
      archive.within(self.arm, 0, kMaxArms);
      archive(self.branch, self.below, self.redo_below, self.undone_from, self.undone_to);
    }
  };
  struct Mark {
    Place place;
    std::uint32_t top = kNone;
    Credits credits{};

    template <class Self, class Archive>
    static void visitState(Self& self, Archive& archive) {
      archive(self.place, self.top, self.credits);
    }
  };
  struct Slice {
    std::uint64_t first, end;
  };

  std::uint32_t addBranch(const Branch& branch);
  std::uint64_t standingEnd(const Stroke& stroke) const;
  Place placeWithout(Stroke& stroke);
  void startJob(const Place& target, std::uint32_t top, std::uint32_t redo_top,
                const Credits& credits);
  void planWay();
  void nextStretch();
  void skipEmptyStretches();
  Slice nextSlice(std::size_t max_voxels) const;
  void finishJob();
  void count(const CarveEntry& entry, bool taken);
  bool isWhole() const;

  CarveLog log_;
  std::vector<Branch> branches_;  // a parent has the smaller number; 0 is the root
  std::vector<Stroke> strokes_;
  std::vector<Mark> marks_;
  std::size_t branch_count_ = 1;
  std::size_t stroke_count_ = 0;
  std::size_t mark_count_ = 1;
  std::size_t settled_marks_ = 1;  // those from here on wait for the end of the job
  std::uint64_t granted_ = 0;      // the log may grow to this length

  Place here_;                    // during a job: where the present stretch began
  std::uint32_t tip_branch_ = 0;  // the newest branch of removal, the one that can grow
  std::uint32_t top_ = kNone;     // the last stroke that stands
  std::uint32_t redo_top_ = kNone;
  std::uint32_t open_[kMaxArms] = {kNone, kNone, kNone, kNone};
  std::uint64_t removed_[kMaxArms][kMaxTissues] = {};
  std::uint64_t paid_[kMaxArms] = {};

  // The job: its end, its way over `meet_branch_`, and the stretch of the log that it is on.
  bool busy_ = false;
  Place target_;
  std::uint32_t job_top_ = kNone;
  std::uint32_t job_redo_top_ = kNone;
  Credits job_credits_{};
  bool climbing_ = false;
  std::uint32_t meet_branch_ = 0;
  std::uint32_t way_down_ = kNone;
  std::uint64_t cursor_ = 0;  // towards a smaller limit it puts back, towards a larger one it takes
  std::uint64_t limit_ = 0;
  std::int32_t stretch_arm_ = -1;  // only this arm's entries; -1: all
  Place stretch_to_;
};

}  // namespace trephine
