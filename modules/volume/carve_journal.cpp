#include "volume/carve_journal.h"

#include <algorithm>

namespace trephine {

CarveJournal::CarveJournal(std::size_t max_voxels, std::size_t max_strokes)
    : entries_(max_voxels),
      strokes_(std::min<std::size_t>(max_strokes, 65535)),
      undone_(strokes_.size()) {}

bool CarveJournal::beginStroke(int arm) {
  if (busy()) return false;
  dropUndone();
  if (stroke_count_ == strokes_.size()) return false;
  strokes_[stroke_count_] = Stroke{};
  strokes_[stroke_count_].first = std::uint32_t(entry_count_);
  strokes_[stroke_count_].end = std::uint32_t(entry_count_);
  strokes_[stroke_count_].arm = arm;
  open_[arm] = std::int32_t(stroke_count_++);
  return true;
}

void CarveJournal::endStroke(int arm) {
  open_[arm] = -1;
}

bool CarveJournal::erase(Grid::Writer& writer, int arm, std::size_t voxel, int tissue_class) {
  if (busy() || open_[arm] < 0 || entry_count_ == entries_.size()) return false;
  // A second entry for a voxel would put back air when the strokes are undone out of order.
  if (writer.grid().hu(voxel) == kAirHu) return true;
  const auto number = std::uint16_t(open_[arm]);
  const std::int16_t old_hu = writer.store(voxel, kAirHu);
  entries_[entry_count_++] = Entry{std::uint32_t(voxel), old_hu, number};
  Stroke& stroke = strokes_[number];
  stroke.end = std::uint32_t(entry_count_);
  ++stroke.removed[tissue_class];
  ++removed_[arm][tissue_class];
  return true;
}

// Strokes that were undone and can no longer be redone. Only those at the end free their room:
// earlier ones keep it, so that the numbers of standing strokes never change.
void CarveJournal::dropUndone() {
  undone_count_ = 0;
  while (stroke_count_ > 0 && strokes_[stroke_count_ - 1].undone) --stroke_count_;
  entry_count_ = 0;
  for (std::size_t i = 0; i < stroke_count_; ++i) {
    entry_count_ = std::max<std::size_t>(entry_count_, strokes_[i].end);
  }
}

bool CarveJournal::startUndo() {
  for (std::size_t i = stroke_count_; i > 0; --i) {
    if (!strokes_[i - 1].undone) return startUndo(i - 1);
  }
  return false;
}

bool CarveJournal::startUndo(std::size_t number) {
  if (busy() || number >= stroke_count_ || strokes_[number].undone) return false;
  std::fill(std::begin(open_), std::end(open_), -1);
  job_ = Job::undo;
  job_stroke_ = number;
  cursor_ = strokes_[number].end;
  return true;
}

bool CarveJournal::startRedo() {
  if (busy() || undone_count_ == 0) return false;
  std::fill(std::begin(open_), std::end(open_), -1);
  job_ = Job::redo;
  job_stroke_ = undone_[undone_count_ - 1];
  cursor_ = strokes_[job_stroke_].first;
  return true;
}

bool CarveJournal::startReset() {
  if (busy() || stroke_count_ == 0) return false;
  std::fill(std::begin(open_), std::end(open_), -1);
  job_ = Job::reset;
  cursor_ = entry_count_;
  return true;
}

bool CarveJournal::step(Grid::Writer& writer, std::size_t max_voxels) {
  std::size_t visits = max_voxels * 8;
  while (busy() && max_voxels > 0 && visits > 0) {
    const bool forward = job_ == Job::redo;
    const std::size_t limit = forward              ? strokes_[job_stroke_].end
                              : job_ == Job::reset ? 0
                                                   : strokes_[job_stroke_].first;
    if (cursor_ == limit) {
      finishJob();
      break;
    }
    --visits;
    const Entry& entry = entries_[forward ? cursor_++ : --cursor_];
    const bool mine =
        job_ == Job::reset ? !strokes_[entry.stroke].undone : entry.stroke == job_stroke_;
    if (!mine) continue;
    writer.store(entry.voxel, forward ? kAirHu : entry.old_hu);
    --max_voxels;
  }
  return busy();
}

void CarveJournal::finishJob() {
  if (job_ == Job::reset) {
    entry_count_ = stroke_count_ = undone_count_ = 0;
    for (auto& arm : removed_) std::fill(std::begin(arm), std::end(arm), 0);
  } else {
    Stroke& stroke = strokes_[job_stroke_];
    stroke.undone = job_ == Job::undo;
    if (stroke.undone) {
      undone_[undone_count_++] = std::uint16_t(job_stroke_);
    } else {
      --undone_count_;
    }
    for (int c = 0; c < kMaxClasses; ++c) {
      if (stroke.undone) {
        removed_[stroke.arm][c] -= stroke.removed[c];
      } else {
        removed_[stroke.arm][c] += stroke.removed[c];
      }
    }
  }
  job_ = Job::none;
}

std::uint64_t CarveJournal::removed(int arm, int tissue_class) const {
  return removed_[arm][tissue_class];
}

}  // namespace trephine
