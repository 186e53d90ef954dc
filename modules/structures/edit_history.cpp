#include "structures/edit_history.h"

#include <algorithm>

namespace trephine {

namespace {

VoxelBox both(const VoxelBox& a, const VoxelBox& b) {
  VoxelBox box = a;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::min(a.low[axis], b.low[axis]);
    box.high[axis] = std::max(a.high[axis], b.high[axis]);
  }
  return box;
}

VoxelBox editedBox(const std::vector<LabelEdit>& edits) {
  if (edits.empty()) return {};
  VoxelBox box = edits.front().box;
  for (const LabelEdit& edit : edits) box = both(box, edit.box);
  return box;
}

void setRow(LabelMap& map, const Structure& to) {
  for (Structure& row : map.structures) {
    if (row.label == to.label) row = to;
  }
}

}  // namespace

void EditHistory::forgetUndone() {
  while (steps_.size() > done_) {
    bytes_ -= steps_.back().bytes;
    steps_.pop_back();
  }
}

void EditHistory::begin(Step step) {
  step.before = version_;
  steps_.push_back(std::move(step));
}

void EditHistory::addRow(const std::string& name, const Structure& before, const Structure& after) {
  if (before == after) return;
  forgetUndone();
  begin({name, {}, 0, Step::Row{before, after}});
  steps_.back().after = version_ = ++last_version_;
  done_ = steps_.size();
}

void EditHistory::add(const std::string& name, LabelEdit edit, bool joins, bool counts) {
  if (edit.empty()) return;
  forgetUndone();
  if (!joins || steps_.empty() || steps_.back().row) begin({name, {}, 0, {}});
  Step& step = steps_.back();
  if (counts) version_ = ++last_version_;
  step.after = version_;
  edit.runs.shrink_to_fit();
  step.bytes += edit.bytes();
  bytes_ += edit.bytes();
  step.edits.push_back(std::move(edit));
  while (bytes_ > most_bytes_) {
    bytes_ -= steps_.front().bytes;
    steps_.pop_front();
    ++dropped_;
  }
  done_ = steps_.size();
}

std::optional<VoxelBox> EditHistory::undo(LabelMap& map) {
  if (done_ == 0) return std::nullopt;
  const Step& step = steps_[--done_];
  version_ = step.before;
  for (auto edit = step.edits.rbegin(); edit != step.edits.rend(); ++edit) {
    trephine::undo(map, *edit);
  }
  if (step.row) setRow(map, step.row->before);
  return editedBox(step.edits);
}

std::optional<VoxelBox> EditHistory::redo(LabelMap& map) {
  if (done_ == steps_.size()) return std::nullopt;
  const Step& step = steps_[done_++];
  version_ = step.after;
  for (const LabelEdit& edit : step.edits) apply(map, edit);
  if (step.row) setRow(map, step.row->after);
  return editedBox(step.edits);
}

void EditHistory::clear() {
  const std::uint64_t last = last_version_;
  *this = EditHistory(most_bytes_);
  version_ = last_version_ = last + 1;
}

}  // namespace trephine
