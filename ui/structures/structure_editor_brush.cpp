// Strokes of the brush and of the wall.
#include <array>
#include <utility>

#include "ui/common/words.h"
#include "ui/structures/structure_editor.h"
#include "ui/views/slice_plane.h"

namespace trephine {

namespace {

const Vec3 kWallColour(0.93);

QString wallName() {
  return StructureEditor::tr("wall");
}

}  // namespace

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
  if (current_ != wall_) stroke_->brush.over |= overWall();
  moveStroke(patient_mm);
}

void StructureEditor::beginWall(const Vec3& patient_mm, const Brush& brush) {
  if (!mayChange()) return;
  std::optional<Regrow> again;
  if (preview_) {  // it ran through here
    const Structure* grown = map_->find(preview_->label);
    again = Regrow{preview_->seed_mm, grown ? toQt(grown->name) : QString()};
  }
  leavePreview();
  if (!map_->find(wall_)) {
    const std::string name = wallName().toStdString();
    wall_ = addStructure(map_->find(name) ? spareName(name) : name);
    if (wall_ == 0) return;
    map_->structures.back().colour = kWallColour;
    emit listChanged();
  }
  const int label = wall_;
  if (const auto voxel = voxelAt(map_->geometry, patient_mm)) {
    const int there = map_->labels[map_->geometry.indexOf((*voxel)[0], (*voxel)[1], (*voxel)[2])];
    const Structure* of = there != label ? map_->find(there) : nullptr;
    if (of) {
      emit said(tr("The wall goes around \"%1\", which counts already: delete it first, paint, and "
                   "grow it anew.")
                    .arg(toQt(of->name)));
    }
  }
  stroke_ = Stroke{label, brush, patient_mm};
  regrow_ = again;
  moveStroke(patient_mm);
}

void StructureEditor::moveStroke(const Vec3& patient_mm) {
  if (!stroke_) return;
  const std::array path{stroke_->last_mm, patient_mm};
  const auto edit = brushEdit(*map_, stroke_->label, path, stroke_->brush,
                              stroke_->brush.hu ? volume_.get() : nullptr);
  stroke_->last_mm = patient_mm;
  if (!edit) {
    stroke_.reset();
    emit failed(edit.error());
    return;
  }
  if (edit->empty()) return;
  const QString step = stroke_->brush.erase ? tr("Erase") : tr("Brush");
  put(step.toStdString(), edit, std::exchange(stroke_->any, true));
}

void StructureEditor::endStroke() {
  if (!stroke_) return;
  stroke_.reset();
  emit listChanged();
  emit stateChanged();
  if (const auto again = std::exchange(regrow_, {})) {
    growAt(again->seed_mm, again->name, grown_with_);
  }
}

}  // namespace trephine
