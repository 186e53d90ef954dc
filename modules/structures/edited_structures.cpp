#include "structures/edited_structures.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "base/memory.h"
#include "base/tr.h"
#include "volume/codes.h"

namespace trephine {

namespace {

std::string numbered(const std::string& name, int n) {
  return name + " " + std::to_string(n);
}

}  // namespace

void EditedStructures::start(std::shared_ptr<const LabelMap> given) {
  given_ = std::move(given);
  own_.reset();
  history_.clear();
  tried_ = {};
  wall_ = 0;
  layer_of_.clear();
  countAll();
}

Status EditedStructures::makeOwn(const GridGeometry& grid) {
  if (own_) return {};
  try {
    own_ = given_ ? std::make_shared<LabelMap>(*given_)
                  : std::make_shared<LabelMap>(
                        LabelMap{grid, std::vector<std::uint8_t>(grid.voxelCount())});
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("to change structures"), tr("the case"));
  }
  given_.reset();
  return {};
}

Result<std::shared_ptr<LabelMap>> EditedStructures::withoutWall() const {
  const std::shared_ptr<const LabelMap> shown = map();
  if (!shown) return std::shared_ptr<LabelMap>();
  try {
    auto copy = std::make_shared<LabelMap>(*shown);
    if (wall_ != 0) {
      std::ranges::replace(copy->labels, std::uint8_t(wall_), std::uint8_t(0));
      std::erase_if(copy->structures, [&](const Structure& s) { return s.label == wall_; });
    }
    return copy->structures.empty() ? nullptr : copy;
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("to use the structures"), tr("the case"));
  }
}

// --- Rows ---

const Structure* EditedStructures::find(int label) const {
  const LabelMap* shown = own_ ? own_.get() : given_.get();
  return shown ? shown->find(label) : nullptr;
}

const Structure* EditedStructures::find(const std::string& name) const {
  const LabelMap* shown = own_ ? own_.get() : given_.get();
  return shown ? shown->find(name) : nullptr;
}

Structure* EditedStructures::row(int label) {
  return &*std::ranges::find(own_->structures, label, &Structure::label);
}

bool EditedStructures::anyVoxels() const {
  return std::ranges::any_of(ml_, [](double ml) { return ml > 0.0; });
}

int EditedStructures::labelAt(const Index3& voxel) const {
  return own_->labels[own_->geometry.indexOf(voxel[0], voxel[1], voxel[2])];
}

int EditedStructures::first() const {
  const std::shared_ptr<const LabelMap> shown = map();
  if (!shown) return 0;
  for (const Structure& s : shown->structures) {
    if (s.label != wall_ && hasVoxels(s.label)) return s.label;
  }
  return 0;
}

std::string EditedStructures::spareName(const std::string& name) const {
  for (int n = 2;; ++n) {
    if (!find(numbered(name, n))) return numbered(name, n);
  }
}

std::string EditedStructures::freeName(const std::string& name) const {
  std::string free = name;
  for (int n = 2;; ++n) {
    const Structure* there = find(free);
    if (!there || !hasVoxels(there->label)) return free;
    free = numbered(name, n);
  }
}

Result<int> EditedStructures::freeLabel() const {
  const int label = int(own_->structures.size()) < kMostStructures ? unusedLabel(*own_) : 0;
  if (label != 0) return label;
  return Error{code::kTooManyStructures,
               tr("The case has {} structures, no more can be made",
                  std::to_string(own_->structures.size())),
               "", tr("Delete one first")};
}

bool EditedStructures::rename(const std::string& step, int label, const std::string& name) {
  for (Structure& other : own_->structures) {
    if (other.label == label || !sameName(other.name, name)) continue;
    if (hasVoxels(other.label)) return false;
    other.name = spareName(other.name);
  }
  Structure& of = *row(label);
  const Structure before = of;
  of.name = name;
  history_.addRow(step, before, of);
  return true;
}

void EditedStructures::recolour(const std::string& step, int label, const Vec3& colour) {
  Structure& of = *row(label);
  const Structure before = of;
  of.colour = colour;
  history_.addRow(step, before, of);
}

// --- Voxels ---

void EditedStructures::countAll() {
  ml_.fill(0.0);
  const std::shared_ptr<const LabelMap> shown = map();
  if (!shown) return;
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t label : shown->labels) ++counts[label];
  const double voxel_ml = shown->geometry.voxelVolume_mm3() / 1000.0;
  for (std::size_t n = 1; n < 256; ++n) ml_[n] = double(counts[n]) * voxel_ml;
}

void EditedStructures::count(const LabelEdit& edit, bool added) {
  const double voxel_ml = own_->geometry.voxelVolume_mm3() / 1000.0;
  for (const LabelEdit::Run& run : edit.runs) {
    const double ml = double(run.count) * voxel_ml * (added ? 1.0 : -1.0);
    ml_[run.after] += ml;
    ml_[run.before] -= ml;
  }
  for (double& ml : ml_) {
    if (std::abs(ml) < 0.1 * voxel_ml) ml = 0.0;  // what adding and taking away leaves
  }
}

bool EditedStructures::isOfWallAlone(const LabelEdit& edit) const {
  const auto isNothing = [&](std::uint8_t label) { return label == 0 || label == wall_; };
  return std::ranges::all_of(edit.runs, [&](const LabelEdit::Run& run) {
    return isNothing(run.before) && isNothing(run.after);
  });
}

std::size_t EditedStructures::put(const std::string& step, const LabelEdit& edit, bool joins) {
  apply(*own_, edit);
  count(edit, true);
  const std::size_t dropped = history_.dropped();
  history_.add(step, edit, joins, !isOfWallAlone(edit));
  return history_.dropped() - dropped;
}

int EditedStructures::layerOf(int layer) const {
  const auto found = layer_of_.find(layer);
  return found != layer_of_.end() && find(found->second) ? found->second : 0;
}

// Its voxels go, which undo brings back; its row stays in the map, empty, for that.
Result<LabelEdit> EditedStructures::removalOf(int label) const {
  const int whole = layerOf(label);
  std::vector<std::uint8_t> stays(own_->labels.size());
  if (whole == 0) return maskEdit(*own_, stays, label);
  std::ranges::transform(own_->labels, stays.begin(),
                         [&](std::uint8_t is) { return is == whole || is == label; });
  Labels over;
  over.set(std::size_t(label));
  return maskEdit(*own_, stays, whole, over);
}

std::optional<VoxelBox> EditedStructures::stepped(const std::optional<VoxelBox>& box) {
  if (box) countAll();
  return box;
}

void EditedStructures::tryOut(const LabelEdit& edit, int row) {
  tried_ = {edit, row};
  apply(*own_, edit);
  count(edit, true);
}

void EditedStructures::takeTried(const std::string& step) {
  history_.add(step, std::exchange(tried_, {}).edit);
}

VoxelBox EditedStructures::leaveTried() {
  const Tried tried = std::exchange(tried_, {});
  trephine::undo(*own_, tried.edit);
  count(tried.edit, false);
  std::erase_if(own_->structures, [&](const Structure& s) { return s.label == tried.row; });
  return tried.edit.box;
}

// --- The wall ---

Result<int> EditedStructures::makeWall(const std::string& name, const Vec3& colour) {
  if (find(wall_)) return wall_;
  const Result<int> label = freeLabel();
  if (!label) return label;
  addRow({*label, find(name) ? spareName(name) : name, colour});
  return wall_ = *label;
}

Labels EditedStructures::overWall() const {
  Labels over;
  if (wall_ != 0) over.set(std::size_t(wall_));
  return over;
}

}  // namespace trephine
