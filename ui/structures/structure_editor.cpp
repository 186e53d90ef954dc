#include "ui/structures/structure_editor.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/codes.h"
#include "base/tr.h"
#include "library/codes.h"
#include "structures/grow_box.h"
#include "ui/common/words.h"
#include "ui/views/slice_plane.h"

namespace trephine {

namespace {

const Vec3 kWallColour(0.93);

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
  structures_.start(structures);
  preview_.reset();
  box_.reset();
  regrow_.reset();
  stroke_.reset();
  saved_ = structures_.version();
  taken_ = saved_;
  current_ =
      structures && !structures->structures.empty() ? structures->structures.front().label : 0;
  emit boxChanged();
  changedRows();
}

void StructureEditor::setLocked(const QString& why) {
  const QString before = std::exchange(locked_, why);
  if (before == why) return;
  stroke_.reset();
  if (why.isEmpty()) emit saidNoMore(before);
  emit stateChanged();
}

std::shared_ptr<const LabelMap> StructureEditor::takeEdited() {
  if (preview_ || stroke_ || busy() || taken_ == version()) return nullptr;
  taken_ = version();
  return finished();  // what was undone is no structure
}

void StructureEditor::giveBack() {
  taken_ = structures_.isOwn() ? std::nullopt : std::optional(version());
}

// Null where nothing but a wall was made, or for want of memory.
std::shared_ptr<LabelMap> StructureEditor::withoutWall() {
  const Result<std::shared_ptr<LabelMap>> copy = structures_.withoutWall();
  if (copy) return *copy;
  emit failed(copy.error());
  return nullptr;
}

std::shared_ptr<const LabelMap> StructureEditor::finished() {
  const std::shared_ptr<LabelMap> copy = withoutWall();
  if (copy) *copy = withoutEmpty(std::move(*copy));
  return copy;
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
    if (structures_.isOwn()) return true;
    const Status own = structures_.makeOwn(volume_->geometry);
    if (own) {
      emit listChanged();  // it is another that is shown now
    } else {
      emit failed(own.error());
    }
    return own.ok();
  }
  return false;
}

bool StructureEditor::begin() {
  if (!mayChange()) return false;
  leavePreview();
  return true;
}

void StructureEditor::changedRows() {
  emit listChanged();
  emit stateChanged();
}

QString StructureEditor::nameOf(int label) const {
  const Structure* of = structures_.find(label);
  return of ? toQt(of->name) : QString();
}

// --- The structures as rows: names, colours, which is current, those that come and go ---

void StructureEditor::setCurrent(int label) {
  if ((label != 0 && !structures_.find(label)) || current_ == label) return;
  current_ = label;
  emit listChanged();
}

Status StructureEditor::rename(int label, const QString& name) {
  const std::string wanted = structureName(name.toStdString());
  if (wanted.empty()) {
    return Error{code::kBadName, trephine::tr("A structure needs a name"), "",
                 trephine::tr("Type one")};
  }
  if (!mayChange() || !structures_.find(label)) return {};
  if (!structures_.rename(tr("Rename").toStdString(), label, wanted)) {
    return Error{code::kBadName,
                 trephine::tr("Another structure is called '{}'", structures_.find(wanted)->name),
                 "", trephine::tr("Choose another name")};
  }
  changedRows();
  return {};
}

bool StructureEditor::setColour(int label, const Vec3& colour) {
  if (!mayChange() || !structures_.find(label)) return false;
  structures_.recolour(tr("Colour").toStdString(), label, colour);
  changedRows();
  return true;
}

void StructureEditor::remove(int label) {
  if (!mayChange() || !structures_.find(label)) return;
  leavePreview();
  const int whole = structures_.layerOf(label);
  put(tr("Delete"), structures_.removalOf(label));
  if (current_ == label) chooseAnother();
  if (whole != 0) emit said(tr("\"%1\" has its layer back.").arg(nameOf(whole)));
}

void StructureEditor::chooseAnother() {
  current_ = structures_.first();
  emit listChanged();
}

std::string StructureEditor::freeName(const QString& wanted) const {
  const std::string base = structureName(wanted.toStdString());
  return structures_.freeName(base.empty() ? tr("structure").toStdString() : base);
}

int StructureEditor::addStructure(const std::string& name, const std::string& like) {
  if (const Structure* there = structures_.find(name)) return there->label;
  const Result<int> label = structures_.freeLabel();
  if (!label) {
    emit failed(label.error());
    return 0;
  }
  Vec3 colour = colourOfNew(tissues_, name, *label);
  if (colour == labelColour(*label) && !like.empty()) colour = colourOfNew(tissues_, like, *label);
  structures_.addRow({*label, name, colour});
  return *label;
}

// --- What changes voxels ---

void StructureEditor::put(const QString& step, const Result<LabelEdit>& edit, bool joins) {
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
  const std::size_t dropped = structures_.put(step.toStdString(), *edit, joins);
  emit changed(edit->box);
  if (dropped > 0) {
    emit said(tr("The first steps can no longer be undone: their memory is full."));
  }
  if (!stroke_) changedRows();  // the list and what can be undone follow at its end
}

void StructureEditor::sayNotMade(const Error& error) {
  if (error.code == code::kCancelled) return emit said(tr("Cancelled: nothing was changed."));
  // A place that was missed is clicked anew: no dialog for that.
  if (error.where == "seed" || error.where == "at") {
    return emit said(toQt(error.what) + QStringLiteral(". ") + toQt(error.next) + '.');
  }
  emit failed(error);
  emit said({});
}

void StructureEditor::growAt(Vec3 patient_mm, const QString& name, const GrowOptions& options) {
  if (!begin()) return;
  const std::optional<Index3> voxel = voxelAt(volume_->geometry, patient_mm);
  if (!voxel) return emit said(tr("Click inside the scan."));
  if (const int label = structures_.labelAt(*voxel)) {
    const QString there = structures_.find(label) ? nameOf(label) : tr("label %1").arg(label);
    return emit said(tr("This place is of \"%1\" already: click beside it, or delete that one to "
                        "grow it anew.")
                         .arg(there));
  }
  if (box_ && !holds(*box_, *voxel)) {
    return emit said(tr("Click inside the box, or take the box away."));
  }
  grown_with_ = options;
  GrowOptions within = options;
  within.box = box_;
  // Without any, looking for them would take a while for nothing.
  if (structures_.anyVoxels()) within.others = map();
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
  const bool is_new = !structures_.find(name);
  const int label = addStructure(name);
  if (label == 0) return;
  // Only what no other structure has.
  const Result<LabelEdit> edit = maskEdit(*map(), grown.mask.labels, label);
  if (!edit) {
    emit failed(edit.error());
    return;
  }
  // A row that was there before is one that undo may fill again.
  structures_.tryOut(*edit, is_new ? label : 0);
  preview_ = Preview{label, millilitres(label), grown.hu, grown.leaked, seed_mm, grown.seed_off_mm};
  current_ = label;
  emit changed(edit->box);
  changedRows();
}

void StructureEditor::takePreview() {
  if (!preview_ || !mayChange()) return;
  structures_.takeTried(tr("Grow %1").arg(nameOf(preview_->label)).toStdString());
  preview_.reset();
  changedRows();
}

void StructureEditor::leavePreview() {
  if (!preview_) return;
  preview_.reset();
  const VoxelBox box = structures_.leaveTried();
  if (!structures_.find(current_) || !structures_.hasVoxels(current_)) chooseAnother();
  emit changed(box);
  changedRows();
}

void StructureEditor::growAnew() {
  if (!preview_ || busy()) return;
  growAt(preview_->seed_mm, nameOf(preview_->label), grown_with_);
}

void StructureEditor::limitTo(const Vec3& from_mm, const Vec3& to_mm, int across) {
  if (!volume_) return;
  const GridGeometry& grid = volume_->geometry;
  const std::optional<VoxelBox> box =
      withSides(box_.value_or(VoxelBox{{0, 0, 0}, grid.size}), grid, from_mm, to_mm, across);
  if (!box) {
    return emit said(tr("That box holds nothing of the scan: draw it wider, inside of the scan."));
  }
  const auto clicked = preview_ ? voxelAt(grid, preview_->seed_mm) : std::nullopt;
  if (clicked && !holds(*box, *clicked)) {
    return emit said(tr("Draw the box around the place that was clicked."));
  }
  box_ = box;
  emit boxChanged();
  emit stateChanged();
  growAnew();
}

std::optional<Vec3> StructureEditor::boxSize_mm() const {
  return box_ ? std::optional(size_mm(*box_, volume_->geometry)) : std::nullopt;
}

void StructureEditor::leaveBox() {
  if (!box_) return;
  box_.reset();
  emit boxChanged();
  emit stateChanged();
  growAnew();
}

// --- Undo ---

std::optional<QString> StructureEditor::undoText() const {
  if (preview_) return tr("Grow");
  const std::string* name = structures_.toUndo();
  return name ? std::optional(toQt(*name)) : std::nullopt;
}

std::optional<QString> StructureEditor::redoText() const {
  const std::string* name = preview_ ? nullptr : structures_.toRedo();
  return name ? std::optional(toQt(*name)) : std::nullopt;
}

void StructureEditor::undo() {
  if (!mayChange()) return;
  if (preview_) return leavePreview();
  stroke_.reset();
  stepped(structures_.undo());
}

void StructureEditor::redo() {
  if (!mayChange() || preview_) return;
  stroke_.reset();
  stepped(structures_.redo());
}

void StructureEditor::stepped(const std::optional<VoxelBox>& box) {
  if (!box) return;
  if (box->high[0] > box->low[0]) emit changed(*box);
  if (current_ != 0 && !structures_.hasVoxels(current_)) chooseAnother();
  changedRows();
}

// --- Strokes of the brush and of the wall ---

void StructureEditor::beginStroke(const Vec3& patient_mm, const Brush& brush, const QString& name) {
  if (!mayChange()) return;
  regrow_.reset();
  if (preview_) takePreview();  // it is what one mends
  if (current_ == 0) {
    if (brush.erase) return emit said(tr("Choose the structure to erase from."));
    current_ = addStructure(freeName(name));
    if (current_ == 0) return;
    emit listChanged();
  }
  stroke_ = Stroke{current_, brush, patient_mm};
  if (current_ != structures_.wall()) stroke_->brush.over |= structures_.overWall();
  moveStroke(patient_mm);
}

void StructureEditor::beginWall(const Vec3& patient_mm, const Brush& brush) {
  if (!mayChange()) return;
  std::optional<Regrow> again;
  if (preview_) again = Regrow{preview_->seed_mm, nameOf(preview_->label)};  // it ran through here
  leavePreview();
  const bool is_new = !structures_.find(structures_.wall());
  const Result<int> wall = structures_.makeWall(tr("wall").toStdString(), kWallColour);
  if (!wall) {
    emit failed(wall.error());
    return;
  }
  if (is_new) emit listChanged();
  const auto voxel = voxelAt(volume_->geometry, patient_mm);
  const int there = voxel ? structures_.labelAt(*voxel) : 0;
  if (there != *wall && structures_.find(there)) {
    emit said(tr("The wall goes around \"%1\", which counts already: delete it first, paint, and "
                 "grow it anew.")
                  .arg(nameOf(there)));
  }
  stroke_ = Stroke{*wall, brush, patient_mm};
  regrow_ = again;
  moveStroke(patient_mm);
}

void StructureEditor::moveStroke(const Vec3& patient_mm) {
  if (!stroke_) return;
  const std::array path{stroke_->last_mm, patient_mm};
  const auto edit = brushEdit(*map(), stroke_->label, path, stroke_->brush,
                              stroke_->brush.hu ? volume_.get() : nullptr);
  stroke_->last_mm = patient_mm;
  if (!edit) {
    stroke_.reset();
    emit failed(edit.error());
    return;
  }
  if (edit->empty()) return;
  put(stroke_->brush.erase ? tr("Erase") : tr("Brush"), edit, std::exchange(stroke_->any, true));
}

void StructureEditor::endStroke() {
  if (!stroke_) return;
  const bool painted_nothing = !stroke_->any && !stroke_->brush.erase && !isWall(stroke_->label);
  if (painted_nothing && structures_.find(stroke_->label)) {  // it may have been deleted meanwhile
    emit said(tr("Nothing changed there: it is of \"%1\" already, or of another structure, which "
                 "keeps it.")
                  .arg(nameOf(stroke_->label)));
  }
  stroke_.reset();
  changedRows();
  if (const auto again = std::exchange(regrow_, {})) {
    growAt(again->seed_mm, again->name, grown_with_);
  }
}

}  // namespace trephine
