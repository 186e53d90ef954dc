#include "ui/structures/structure_editor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <utility>

#include "base/codes.h"
#include "base/memory.h"
#include "structures/skin.h"
#include "structures/skull.h"
#include "ui/common/words.h"
#include "ui/views/slice_plane.h"

namespace trephine {

namespace {

bool isIn(const VoxelBox& box, const Index3& voxel) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (voxel[axis] < box.low[axis] || voxel[axis] >= box.high[axis]) return false;
  }
  return true;
}

}  // namespace

StructureEditor::StructureEditor(QObject* parent) : QObject(parent) {
  connect(&work_, &BackgroundTask::progressed, this, &StructureEditor::progressed);
  connect(&work_, &BackgroundTask::began, this, &StructureEditor::stateChanged);
  connect(&work_, &BackgroundTask::ended, this, &StructureEditor::stateChanged);
}

void StructureEditor::setCase(std::shared_ptr<const Volume> volume,
                              const std::shared_ptr<const LabelMap>& structures) {
  work_.cancel();
  volume_ = std::move(volume);
  map_.reset();
  given_ = structures;
  history_.clear();
  preview_.reset();
  box_.reset();
  regrow_.reset();
  wall_ = 0;
  shell_of_.clear();
  stroke_.reset();
  edited_ = untaken_ = false;
  current_ = given_ && !given_->structures.empty() ? given_->structures.front().label : 0;
  countAll();
  emit boxChanged();
  emit listChanged();
  emit stateChanged();
}

void StructureEditor::setLocked(const QString& why) {
  const QString before = std::exchange(locked_, why);
  if (before == why) return;
  stroke_.reset();
  if (why.isEmpty()) emit saidNoMore(before);
  emit stateChanged();
}

std::shared_ptr<const LabelMap> StructureEditor::takeEdited() {
  if (preview_ || stroke_ || busy() || !std::exchange(untaken_, false)) return nullptr;
  return withoutWall();
}

void StructureEditor::touched() {
  edited_ = untaken_ = true;
  ++changes_;
}

// Null where nothing but a wall was made, or for want of memory.
std::shared_ptr<LabelMap> StructureEditor::withoutWall() {
  const std::shared_ptr<const LabelMap> shown = map();
  if (!shown) return nullptr;
  try {
    auto copy = std::make_shared<LabelMap>(*shown);
    if (wall_ != 0) {
      std::ranges::replace(copy->labels, std::uint8_t(wall_), std::uint8_t(0));
      std::erase_if(copy->structures, [&](const Structure& s) { return s.label == wall_; });
    }
    return copy->structures.empty() ? nullptr : copy;
  } catch (const std::bad_alloc&) {
    emit failed(outOfMemory("to use the structures", "the case"));
    return nullptr;
  }
}

std::shared_ptr<const LabelMap> StructureEditor::finished() {
  const std::shared_ptr<LabelMap> copy = withoutWall();
  if (copy) *copy = withoutEmpty(std::move(*copy));
  return copy;
}

// What is made takes the wall's voxels: they are of nothing.
Labels StructureEditor::overWall() const {
  Labels over;
  if (wall_ != 0) over.set(std::size_t(wall_));
  return over;
}

bool StructureEditor::mayChange() {
  if (!volume_) {
    emit said(tr("Open a case first."));
  } else if (!locked_.isEmpty()) {
    emit said(locked_);
  } else if (busy()) {
    emit said(tr("Wait for what is being done, or cancel it."));
  } else {
    emit said({});  // what was said of the last one
    return makeOwn();
  }
  return false;
}

// A map of its own, where there is none yet.
bool StructureEditor::makeOwn() {
  if (map_) return true;
  try {
    if (given_) {
      map_ = std::make_shared<LabelMap>(*given_);
    } else {
      const std::size_t voxels = volume_->geometry.voxelCount();
      map_ = std::make_shared<LabelMap>(
          LabelMap{volume_->geometry, std::vector<std::uint8_t>(voxels)});
    }
  } catch (const std::bad_alloc&) {
    emit failed(outOfMemory("to change structures", "the case"));
    return false;
  }
  given_.reset();
  emit listChanged();  // it is another that is shown now
  return true;
}

const Structure* StructureEditor::structure(int label) const {
  const LabelMap* shown = map_ ? map_.get() : given_.get();
  return shown ? shown->find(label) : nullptr;
}

// --- What changes voxels ---

void StructureEditor::countAll() {
  ml_.fill(0.0);
  const std::shared_ptr<const LabelMap> shown = map();
  if (!shown) return;
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t label : shown->labels) ++counts[label];
  const double voxel_ml = shown->geometry.voxelVolume_mm3() / 1000.0;
  for (std::size_t n = 1; n < 256; ++n) ml_[n] = double(counts[n]) * voxel_ml;
}

void StructureEditor::count(const LabelEdit& edit, bool added) {
  const double voxel_ml = map_->geometry.voxelVolume_mm3() / 1000.0;
  for (const LabelEdit::Run& run : edit.runs) {
    const double ml = double(run.count) * voxel_ml * (added ? 1.0 : -1.0);
    ml_[run.after] += ml;
    ml_[run.before] -= ml;
  }
  for (double& ml : ml_) {
    if (std::abs(ml) < 0.1 * voxel_ml) ml = 0.0;  // what adding and taking away leaves
  }
}

void StructureEditor::applied(const LabelEdit& edit, bool added) {
  count(edit, added);
  touched();
  emit changed(edit.box);
}

void StructureEditor::put(const std::string& step, const Result<LabelEdit>& edit, bool joins) {
  if (!edit) {
    emit failed(edit.error());
    return;
  }
  if (edit->empty()) {
    if (!joins && !stroke_) {
      emit said(tr("Nothing was changed: it is so already, as finely as the voxels go."));
    }
    return;
  }
  trephine::apply(*map_, *edit);
  applied(*edit, true);
  const std::size_t dropped = history_.dropped();
  history_.add(step, *edit, joins);
  if (history_.dropped() > dropped) {
    emit said(tr("The first steps can no longer be undone: their memory is full."));
  }
  if (stroke_) return;  // the list and what can be undone follow at its end
  emit listChanged();
  emit stateChanged();
}

// `take` gets what the work made, unless the case is gone by then.
template <class Work, class Take>
void StructureEditor::inBackground(Work work, Take take) {
  using Made = std::invoke_result_t<Work&, const Progress&>;
  work_.run(std::move(work), [this, take, own = map_](Made made) {
    if (map_ != own) return;
    if (made) return take(*std::move(made));
    const Error& error = made.error();
    if (error.code == code::kCancelled) return emit said(tr("Cancelled: nothing was changed."));
    // A place that was missed is clicked anew: no dialog for that.
    if (error.where == "seed" || error.where == "at") {
      return emit said(toQt(error.what) + QStringLiteral(". ") + toQt(error.next) + '.');
    }
    emit failed(error);
    emit said({});
  });
}

template <class Make>
void StructureEditor::editInBackground(Make make, const QString& step) {
  inBackground(std::move(make),
               [this, step](LabelEdit edit) { put(step.toStdString(), std::move(edit)); });
}

void StructureEditor::growAt(Vec3 patient_mm, const QString& name, const GrowOptions& options) {
  if (!mayChange()) return;
  leavePreview();
  const std::optional<Index3> voxel = voxelAt(map_->geometry, patient_mm);
  if (!voxel) return emit said(tr("Click inside the scan."));
  if (const int label =
          map_->labels[map_->geometry.indexOf((*voxel)[0], (*voxel)[1], (*voxel)[2])]) {
    const Structure* there = map_->find(label);
    return emit said(tr("This place is of \"%1\" already: click beside it, or delete that one to "
                        "grow it anew.")
                         .arg(there ? toQt(there->name) : tr("label %1").arg(label)));
  }
  if (box_ && !isIn(*box_, *voxel)) {
    return emit said(tr("Click inside the box, or take the box away."));
  }
  grown_with_ = options;
  GrowOptions within = options;
  within.box = box_;
  // Without any, looking for them would take a while for nothing.
  if (std::ranges::any_of(ml_, [](double ml) { return ml > 0.0; })) within.others = map_;
  inBackground(
      [volume = volume_, patient_mm, within](const Progress& progress) {
        return grow(*volume, patient_mm, within, progress);
      },
      [this, wanted = freeName(name), patient_mm](const Growth& grown) {
        showGrown(grown, wanted, patient_mm);
      });
}

// As a preview.
void StructureEditor::showGrown(const Growth& grown, const std::string& name, const Vec3& seed_mm) {
  if (!locked_.isEmpty()) return;  // an exercise began meanwhile
  preview_has_new_row_ = !map_->find(name);
  const int label = addStructure(name);
  if (label == 0) return;
  // Only what no other structure has.
  auto edit = maskEdit(*map_, grown.mask.labels, label);
  if (!edit) {
    emit failed(edit.error());
    return;
  }
  preview_edit_ = *std::move(edit);
  trephine::apply(*map_, preview_edit_);
  count(preview_edit_, true);
  preview_ =
      Preview{label, ml_[std::size_t(label)], grown.hu, grown.leaked, seed_mm, grown.seed_off_mm};
  current_ = label;
  emit changed(preview_edit_.box);
  emit listChanged();
  emit stateChanged();
}

void StructureEditor::takePreview() {
  if (!preview_ || !mayChange()) return;
  const Structure* grown = map_->find(preview_->label);
  preview_.reset();
  touched();
  history_.add(tr("Grow %1").arg(toQt(grown->name)).toStdString(),
               std::exchange(preview_edit_, {}));
  emit listChanged();
  emit stateChanged();
}

void StructureEditor::leavePreview() {
  if (!preview_) return;
  const int label = preview_->label;
  preview_.reset();
  trephine::undo(*map_, preview_edit_);
  count(preview_edit_, false);
  const VoxelBox box = preview_edit_.box;
  preview_edit_ = {};
  // A row that was there before is one that undo may fill again.
  if (preview_has_new_row_) {
    std::erase_if(map_->structures, [&](const Structure& s) { return s.label == label; });
  }
  if (!map_->find(current_) || ml_[std::size_t(current_)] == 0.0) chooseAnother();
  emit changed(box);
  emit listChanged();
  emit stateChanged();
}

void StructureEditor::growAnew() {
  if (!preview_ || busy()) return;
  const Structure* grown = map_->find(preview_->label);
  growAt(preview_->seed_mm, grown ? toQt(grown->name) : QString(), grown_with_);
}

void StructureEditor::limitTo(const Vec3& from_mm, const Vec3& to_mm, int across) {
  if (!volume_) return;
  const GridGeometry& g = volume_->geometry;
  const Vec3 from = toVoxel(g, from_mm), to = toVoxel(g, to_mm);
  VoxelBox box = box_.value_or(VoxelBox{{0, 0, 0}, g.size});
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == across) continue;
    const auto a = std::size_t(axis);
    const double last = g.size[a];
    box.low[a] = int(std::clamp(std::ceil(std::min(from[axis], to[axis])), 0.0, last));
    box.high[a] = int(std::clamp(std::floor(std::max(from[axis], to[axis])) + 1.0, 0.0, last));
    if (box.low[a] >= box.high[a]) {
      return emit said(
          tr("That box holds nothing of the scan: draw it wider, inside of the scan."));
    }
  }
  const auto clicked = preview_ ? voxelAt(g, preview_->seed_mm) : std::nullopt;
  if (clicked && !isIn(box, *clicked)) {
    return emit said(tr("Draw the box around the place that was clicked."));
  }
  box_ = box;
  emit boxChanged();
  emit stateChanged();
  growAnew();
}

std::optional<Vec3> StructureEditor::boxSize_mm() const {
  if (!box_) return {};
  Vec3 mm = volume_->geometry.spacing_mm;
  for (int axis = 0; axis < 3; ++axis) {
    mm[axis] *= box_->high[std::size_t(axis)] - box_->low[std::size_t(axis)];
  }
  return mm;
}

void StructureEditor::leaveBox() {
  if (!box_) return;
  box_.reset();
  emit boxChanged();
  emit stateChanged();
  growAnew();
}

void StructureEditor::putMask(const std::vector<std::uint8_t>& mask, const std::string& name,
                              const std::string& like) {
  const int label = addStructure(name, like);
  if (label == 0) return;
  put(name, maskEdit(*map_, mask, label, overWall()));
  setCurrent(label);
}

void StructureEditor::makeSkull() {
  if (!mayChange()) return;
  leavePreview();
  inBackground([volume = volume_](const Progress& progress) { return skullOf(*volume, progress); },
               [this](const Skull& made) {
                 putMask(made.mask.labels, "skull", "bone");
                 sayMade({});
               });
}

// What is current now was made.
void StructureEditor::sayMade(const QString& more) {
  if (const Structure* of = structure(current_)) {
    emit said(tr("%1: %2 mL.").arg(toQt(of->name)).arg(millilitres(current_), 0, 'f', 0) + more);
  }
}

// A layer is a voxel thick at least.
QString StructureEditor::wordsIfThin(double thickness_mm) const {
  const Vec3& mm = volume_->geometry.spacing_mm;
  const double voxel_mm = std::max({mm.x, mm.y, mm.z});
  if (thickness_mm >= voxel_mm) return {};
  return ' ' +
         tr("It is one voxel thick, which is up to %1 mm on this CT.").arg(voxel_mm, 0, 'f', 1);
}

void StructureEditor::makeSkin(double thickness_mm) {
  if (!mayChange()) return;
  leavePreview();
  inBackground([volume = volume_, thickness_mm](
                   const Progress& progress) { return skinOf(*volume, thickness_mm, progress); },
               [this, thickness_mm](const Skin& made) {
                 putMask(made.mask.labels, "skin", "scalp");
                 sayMade(wordsIfThin(thickness_mm));
               });
}

void StructureEditor::makeShell(double thickness_mm, const QString& name) {
  if (!mayChange() || current_ == 0) return;
  leavePreview();
  const int of = current_;
  const int into = addStructure(freeName(name));
  if (into == 0) return;
  inBackground([map = std::shared_ptr<const LabelMap>(map_), of, thickness_mm,
                into](const Progress& p) { return shellEdit(*map, of, thickness_mm, into, p); },
               [this, of, into, thickness_mm](LabelEdit edit) {
                 const bool any = !edit.empty();
                 put(tr("Shell").toStdString(), std::move(edit));
                 if (!any) return;
                 shell_of_[into] = of;
                 emit said(tr("\"%1\" has %2 mL of \"%3\", which keeps %4 mL. Deleting it gives "
                              "them back.")
                               .arg(toQt(map_->find(into)->name))
                               .arg(millilitres(into), 0, 'f', 0)
                               .arg(toQt(map_->find(of)->name))
                               .arg(millilitres(of), 0, 'f', 0) +
                           wordsIfThin(thickness_mm));
               });
}

void StructureEditor::fillHoles() {
  if (!mayChange() || current_ == 0) return;
  leavePreview();
  editInBackground([map = std::shared_ptr<const LabelMap>(map_), of = current_](
                       const Progress& p) { return holesEdit(*map, of, std::nullopt, {}, p); },
                   tr("Fill holes"));
}

void StructureEditor::smooth(double radius_mm) {
  if (!mayChange() || current_ == 0) return;
  leavePreview();
  editInBackground([map = std::shared_ptr<const LabelMap>(map_), of = current_, radius_mm](
                       const Progress& p) { return smoothEdit(*map, of, radius_mm, {}, p); },
                   tr("Smooth"));
}

void StructureEditor::keepPieceAt(const Vec3& patient_mm) {
  if (!mayChange() || current_ == 0) return;
  leavePreview();
  editInBackground([map = std::shared_ptr<const LabelMap>(map_), of = current_,
                    patient_mm](const Progress&) { return keepPieceEdit(*map, of, patient_mm); },
                   tr("Keep the piece"));
}

// --- Undo ---

std::optional<QString> StructureEditor::undoText() const {
  if (preview_) return tr("Grow");
  const std::string* name = history_.toUndo();
  return name ? std::optional(toQt(*name)) : std::nullopt;
}

std::optional<QString> StructureEditor::redoText() const {
  const std::string* name = preview_ ? nullptr : history_.toRedo();
  return name ? std::optional(toQt(*name)) : std::nullopt;
}

void StructureEditor::undo() {
  if (!mayChange()) return;
  if (preview_) return leavePreview();
  stroke_.reset();
  stepped(history_.undo(*map_));
}

void StructureEditor::redo() {
  if (!mayChange() || preview_) return;
  stroke_.reset();
  stepped(history_.redo(*map_));
}

void StructureEditor::stepped(const std::optional<VoxelBox>& box) {
  if (!box) return;
  countAll();
  touched();
  if (box->high[0] > box->low[0]) emit changed(*box);
  if (current_ != 0 && ml_[std::size_t(current_)] == 0.0) chooseAnother();
  emit listChanged();
  emit stateChanged();
}

}  // namespace trephine
