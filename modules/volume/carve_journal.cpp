#include "volume/carve_journal.h"

#include <algorithm>
#include <bit>

namespace trephine {

// A stroke needs at most one branch to remove on and mostly none to be undone.
CarveJournal::CarveJournal(std::size_t ring_voxels, std::size_t max_strokes,
                           std::size_t max_seconds)
    : log_(ring_voxels),
      branches_(2 * max_strokes + 2),
      strokes_(max_strokes),
      marks_(max_seconds + 1) {}

std::size_t CarveJournal::ramBytes() const {
  return log_.ramBytes() + branches_.size() * sizeof(Branch) + strokes_.size() * sizeof(Stroke) +
         marks_.size() * sizeof(Mark);
}

std::uint32_t CarveJournal::addBranch(const Branch& branch) {
  branches_[branch_count_] = branch;
  return std::uint32_t(branch_count_++);
}

// ---- Removal.

bool CarveJournal::beginStroke(int arm, const Credits& now) {
  if (busy_ || stroke_count_ == strokes_.size()) return false;
  if (here_ != Place{tip_branch_, log_.size()}) {
    if (branch_count_ == branches_.size()) return false;
    Branch branch;
    branch.parent = here_;
    branch.first = log_.size();
    tip_branch_ = addBranch(branch);
    here_ = Place{tip_branch_, log_.size()};
  }
  Stroke& stroke = strokes_[stroke_count_];
  stroke.first = stroke.end = log_.size();
  stroke.credits = now;
  stroke.arm = arm;
  stroke.branch = tip_branch_;
  stroke.below = top_;
  top_ = open_[arm] = std::uint32_t(stroke_count_++);
  redo_top_ = kNone;
  return true;
}

bool CarveJournal::hasRoom(std::size_t entries) {
  const bool room = log_.hasRoom(entries);
  granted_ = log_.size() + (room ? entries : 0);
  return room;
}

void CarveJournal::count(const CarveEntry& entry, bool taken) {
  std::uint64_t& voxels = removed_[entry.arm()][entry.tissueClass()];
  voxels = taken ? voxels + 1 : voxels - 1;
  const std::uint32_t payers = entry.payers();
  const auto share = std::uint64_t(kVoxelShares / std::popcount(payers));
  for (int arm = 0; arm < kMaxArms; ++arm) {
    if (!(payers >> arm & 1u)) continue;
    paid_[arm] = taken ? paid_[arm] + share : paid_[arm] - share;
  }
}

bool CarveJournal::erase(Grid::Writer& writer, int arm, std::size_t voxel, int tissue_class,
                         std::uint32_t sharers) {
  if (busy_ || open_[arm] == kNone || log_.size() >= granted_) return false;
  // A second entry for a voxel would put back air.
  if (writer.grid().hu(voxel) == kAirHu) return true;
  const std::int16_t hu = writer.store(voxel, kAirHu);
  const CarveEntry entry{std::uint32_t(voxel), hu, CarveEntry::makeTag(arm, tissue_class, sharers)};
  log_.append(entry);
  here_.entry = log_.size();
  Stroke& stroke = strokes_[open_[arm]];
  stroke.end = log_.size();
  ++stroke.voxels;
  count(entry, true);
  return true;
}

void CarveJournal::mark(const Credits& now) {
  if (mark_count_ == marks_.size()) return;
  marks_[mark_count_++] = Mark{here_, top_, now};
  if (!busy_) settled_marks_ = mark_count_;
}

// ---- Starting jobs.

// Where the stroke's entries end that stand at the present place: a rewind into the stroke cut it.
std::uint64_t CarveJournal::standingEnd(const Stroke& stroke) const {
  Place place = here_;
  while (place.branch > stroke.branch) place = branches_[place.branch].parent;
  // A stroke cut before its first voxel may have its branch beside the way: what is on the way is
  // older then, and the clamp makes it empty.
  return std::clamp(place.entry, stroke.first, stroke.end);
}

// The place that is like the present one without the stroke, which is the last that stands.
CarveJournal::Place CarveJournal::placeWithout(Stroke& stroke) {
  if (stroke.undone_from == here_) return stroke.undone_to;
  const std::uint64_t end = standingEnd(stroke);
  Place place = here_;
  const bool alone = stroke.voxels == stroke.end - stroke.first;
  if (alone && here_ == Place{stroke.branch, end}) {
    place.entry = stroke.first;
  } else if (end > stroke.first) {
    Branch branch;
    branch.parent = here_;
    branch.first = stroke.first;
    branch.end = end;
    branch.arm = stroke.arm;
    return {addBranch(branch), branch.first};
  }
  // A branch's beginning is its parent's place: later ways need not lead over this branch.
  while (place.branch != 0 && !branches_[place.branch].isUndo() &&
         place.entry == branches_[place.branch].first) {
    place = branches_[place.branch].parent;
  }
  return place;
}

bool CarveJournal::startUndo(const Credits& now) {
  if (busy_ || !canUndo()) return false;
  Stroke& stroke = strokes_[top_];
  const Place place = placeWithout(stroke);
  stroke.undone_from = here_;
  stroke.undone_to = place;
  stroke.redo_below = redo_top_;
  stroke.credit_before_undo = now[std::size_t(stroke.arm)];
  Credits credits = now;
  credits[std::size_t(stroke.arm)] = stroke.credits[std::size_t(stroke.arm)];
  startJob(place, stroke.below, top_, credits);
  return true;
}

bool CarveJournal::startRedo(const Credits& now) {
  if (busy_ || !canRedo()) return false;
  const Stroke& stroke = strokes_[redo_top_];
  // What the stroke cost is spent again: an undo and a redo must not fill the credit.
  Credits credits = now;
  double& of_arm = credits[std::size_t(stroke.arm)];
  of_arm = std::min(of_arm, stroke.credit_before_undo);
  startJob(stroke.undone_from, redo_top_, stroke.redo_below, credits);
  return true;
}

bool CarveJournal::startRewind(std::size_t second, const Credits& now) {
  if (busy_ || second >= mark_count_) return false;
  const Mark& mark = marks_[second];
  if (mark.place == here_ && mark.top == top_ && mark.credits == now) return false;
  startJob(mark.place, mark.top, kNone, mark.credits);
  return true;
}

void CarveJournal::startJob(const Place& target, std::uint32_t top, std::uint32_t redo_top,
                            const Credits& credits) {
  std::fill(std::begin(open_), std::end(open_), kNone);
  busy_ = true;
  target_ = target;
  job_top_ = top;
  job_redo_top_ = redo_top;
  job_credits_ = credits;
  planWay();
  skipEmptyStretches();
}

// ---- The way: up from the present place to the branch that both places have in common, along it,
// and down to the target. Each branch on it is one stretch of the log.

void CarveJournal::planWay() {
  std::uint32_t up = here_.branch, down = target_.branch;
  way_down_ = kNone;
  while (up != down) {
    if (up > down) {
      up = branches_[up].parent.branch;
    } else {
      branches_[down].way_down = way_down_;
      way_down_ = down;
      down = branches_[down].parent.branch;
    }
  }
  meet_branch_ = up;
  climbing_ = true;
  cursor_ = limit_ = 0;
  stretch_to_ = here_;
}

void CarveJournal::nextStretch() {
  here_ = stretch_to_;
  stretch_arm_ = -1;
  if (climbing_ && here_.branch != meet_branch_) {
    const Branch& branch = branches_[here_.branch];
    cursor_ = here_.entry;
    limit_ = branch.isUndo() ? branch.end : branch.first;
    stretch_arm_ = branch.arm;
    stretch_to_ = branch.parent;
    return;
  }
  if (climbing_) {
    climbing_ = false;
    cursor_ = here_.entry;
    stretch_to_ = way_down_ == kNone ? target_ : branches_[way_down_].parent;
    limit_ = stretch_to_.entry;
    return;
  }
  const Branch& branch = branches_[way_down_];
  way_down_ = branch.way_down;
  stretch_to_ = way_down_ == kNone ? target_ : branches_[way_down_].parent;
  cursor_ = branch.isUndo() ? branch.end : branch.first;
  limit_ = stretch_to_.entry;  // of an undo: its first
  stretch_arm_ = branch.arm;
}

void CarveJournal::skipEmptyStretches() {
  while (cursor_ == limit_ && (climbing_ || way_down_ != kNone)) nextStretch();
}

// What the next step visits at most: within one stretch, and no more than is loaded in one go.
CarveJournal::Slice CarveJournal::nextSlice(std::size_t max_voxels) const {
  const std::uint64_t visits =
      std::min(std::min(max_voxels, CarveLog::kLoadEntries) * 8, CarveLog::kLoadEntries);
  if (cursor_ > limit_) return {cursor_ - std::min(visits, cursor_ - limit_), cursor_};
  return {cursor_, cursor_ + std::min(visits, limit_ - cursor_)};
}

bool CarveJournal::canStep(std::size_t max_voxels) {
  if (!busy_) return true;
  const Slice slice = nextSlice(max_voxels);
  if (log_.isReady(slice.first, slice.end)) return true;
  // As much of the stretch as one load holds, so that the next slices need no other.
  const std::uint64_t oldest_in_ring = log_.ringBegin();
  if (cursor_ > limit_) {
    const std::uint64_t end = std::min(cursor_, oldest_in_ring);
    log_.requestLoad(end - std::min<std::uint64_t>(end - limit_, CarveLog::kLoadEntries), end);
  } else {
    const std::uint64_t end = std::min(limit_, oldest_in_ring);
    log_.requestLoad(cursor_, std::min(end, cursor_ + CarveLog::kLoadEntries));
  }
  return false;
}

bool CarveJournal::step(Grid::Writer& writer, std::size_t max_voxels,
                        std::vector<std::uint32_t>* changed) {
  if (!busy_) return false;
  const Slice slice = nextSlice(max_voxels);
  if (!log_.isReady(slice.first, slice.end)) return true;
  const bool put_back = cursor_ > limit_;
  for (std::uint64_t visits = slice.end - slice.first; visits > 0 && max_voxels > 0; --visits) {
    const CarveEntry& entry = log_.at(put_back ? --cursor_ : cursor_++);
    const int arm = entry.arm();
    if (stretch_arm_ >= 0 && arm != stretch_arm_) continue;
    writer.store(entry.voxel, put_back ? entry.hu : kAirHu);
    if (changed) changed->push_back(entry.voxel);
    count(entry, !put_back);
    --max_voxels;
  }
  skipEmptyStretches();
  if (cursor_ == limit_) finishJob();
  return busy_;
}

void CarveJournal::finishJob() {
  busy_ = false;
  here_ = target_;
  top_ = job_top_;
  redo_top_ = job_redo_top_;
  while (settled_marks_ < mark_count_) {
    marks_[settled_marks_++] = Mark{here_, top_, job_credits_};
  }
}

// ---- As a state.

// FNV-1a, 64 bits.
std::uint64_t CarveJournal::hashOfPlace(const Grid& grid) const {
  std::uint64_t hash = 0xCBF29CE484222325u;
  const auto add = [&hash](std::uint64_t number) {
    for (int byte = 0; byte < 8; ++byte) {
      hash = (hash ^ (number >> (8 * byte) & 0xFFu)) * 0x100000001B3u;
    }
  };
  const std::size_t voxels = grid.geometry().voxelCount();
  add(log_.size());
  for (std::uint64_t n = log_.ringBegin(); n < log_.size(); ++n) {
    const CarveEntry& entry = log_.at(n);
    const bool stands = entry.voxel < voxels && grid.hu(entry.voxel) == kAirHu;
    add(std::uint64_t(entry.voxel) << 32 | std::uint64_t(std::uint16_t(entry.hu)) << 16 |
        entry.tag);
    add(stands);
  }
  return hash;
}

// Whether everything that is named is there.
bool CarveJournal::isWhole() const {
  const auto isStroke = [this](std::uint32_t n) { return n == kNone || n < stroke_count_; };
  const auto isBranch = [this](std::uint32_t n) { return n < branch_count_; };
  const auto isPlace = [&](const Place& place) {
    return isBranch(place.branch) && place.entry <= log_.size();
  };
  bool whole = branch_count_ > 0 && mark_count_ > 0 && settled_marks_ > 0 &&
               settled_marks_ <= mark_count_ && isPlace(here_) && isBranch(tip_branch_) &&
               isStroke(top_) && isStroke(redo_top_);
  for (std::size_t n = 0; n < branch_count_; ++n) {
    const Branch& branch = branches_[n];
    whole = whole && isPlace(branch.parent) && (n == 0 || branch.parent.branch < n) &&
            branch.first <= log_.size() && branch.end <= log_.size() &&
            (branch.way_down == kNone || isBranch(branch.way_down));
  }
  for (std::size_t n = 0; n < stroke_count_; ++n) {
    const Stroke& stroke = strokes_[n];
    const bool undone = stroke.undone_from.branch != kNone;
    whole = whole && stroke.first <= stroke.end && stroke.end <= log_.size() &&
            isBranch(stroke.branch) && isStroke(stroke.below) && isStroke(stroke.redo_below) &&
            (!undone || (isPlace(stroke.undone_from) && isPlace(stroke.undone_to)));
  }
  for (std::size_t n = 0; n < mark_count_; ++n) {
    whole = whole && isPlace(marks_[n].place) && isStroke(marks_[n].top);
  }
  for (std::uint32_t open : open_) whole = whole && isStroke(open);
  if (!busy_) return whole;
  return whole && isPlace(target_) && isPlace(stretch_to_) && isStroke(job_top_) &&
         isStroke(job_redo_top_) && isBranch(meet_branch_) &&
         (way_down_ == kNone || isBranch(way_down_)) && cursor_ <= log_.size() &&
         limit_ <= log_.size() && stretch_arm_ < kMaxArms;
}

}  // namespace trephine
