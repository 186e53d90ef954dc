// The structures as rows: names, colours, which is current, those that come and go.
#include <algorithm>

#include "library/codes.h"
#include "ui/common/words.h"
#include "ui/structures/structure_editor.h"
#include "volume/codes.h"

namespace trephine {

void StructureEditor::setCurrent(int label) {
  if ((label != 0 && !structure(label)) || current_ == label) return;
  current_ = label;
  emit listChanged();
}

Status StructureEditor::rename(int label, const QString& name) {
  const std::string wanted = structureName(name.toStdString());
  if (wanted.empty()) {
    return Error{code::kBadName, "A structure needs a name", "", "Type one"};
  }
  if (!mayChange()) return {};
  for (Structure& s : map_->structures) {
    if (s.label == label || !sameName(s.name, wanted)) continue;
    if (ml_[std::size_t(s.label)] == 0.0) {  // deleted: it gives its name away
      s.name = spareName(s.name);
    } else {
      return Error{code::kBadName, "Another structure is called '" + s.name + "'", "",
                   "Choose another name"};
    }
  }
  for (Structure& s : map_->structures) {
    if (s.label != label) continue;
    const Structure before = s;
    s.name = wanted;
    history_.addRow(tr("Rename").toStdString(), before, s);
  }
  touched();
  emit listChanged();
  emit stateChanged();
  return {};
}

bool StructureEditor::setColour(int label, const Vec3& colour) {
  if (!mayChange()) return false;
  for (Structure& s : map_->structures) {
    if (s.label != label) continue;
    const Structure before = s;
    s.colour = colour;
    history_.addRow(tr("Colour").toStdString(), before, s);
  }
  touched();
  emit listChanged();
  emit stateChanged();
  return true;
}

// Its voxels go, which undo brings back; its row stays in the map, empty, for that.
void StructureEditor::remove(int label) {
  if (!mayChange() || !map_->find(label)) return;
  leavePreview();
  const auto shell = shell_of_.find(label);
  const int whole = shell != shell_of_.end() && map_->find(shell->second) ? shell->second : 0;
  std::vector<std::uint8_t> stays(map_->labels.size());
  Labels over;
  if (whole != 0) {
    over.set(std::size_t(label));
    for (std::size_t v = 0; v < stays.size(); ++v) {
      stays[v] = map_->labels[v] == whole || map_->labels[v] == label;
    }
  }
  put(tr("Delete").toStdString(), maskEdit(*map_, stays, whole != 0 ? whole : label, over));
  if (current_ == label) chooseAnother();
  if (whole != 0) emit said(tr("\"%1\" has its layer back.").arg(toQt(map_->find(whole)->name)));
}

// The first that has voxels.
void StructureEditor::chooseAnother() {
  current_ = 0;
  for (const Structure& s : map_->structures) {
    if (current_ == 0 && s.label != wall_ && ml_[std::size_t(s.label)] > 0.0) current_ = s.label;
  }
  emit listChanged();
}

// One that no row has, with or without voxels.
std::string StructureEditor::spareName(const std::string& base) const {
  for (int n = 2;; ++n) {
    const std::string name = base + " " + std::to_string(n);
    if (!map_->find(name)) return name;
  }
}

std::string StructureEditor::freeName(const QString& wanted) const {
  std::string base = structureName(wanted.toStdString());
  if (base.empty()) base = tr("structure").toStdString();
  std::string name = base;
  for (int n = 2;; ++n) {
    const Structure* there = map_->find(name);
    if (!there || ml_[std::size_t(there->label)] == 0.0) return name;
    name = base + " " + std::to_string(n);
  }
}

// The label of a structure of this name, which is made where there is none; 0: there are too many.
int StructureEditor::addStructure(const std::string& name, const std::string& like) {
  if (const Structure* there = map_->find(name)) return there->label;
  const int label = int(map_->structures.size()) < kMostStructures ? unusedLabel(*map_) : 0;
  if (label == 0) {
    emit failed({code::kTooManyStructures,
                 "The case has " + std::to_string(map_->structures.size()) +
                     " structures, no more "
                     "can be made",
                 "", "Delete one first"});
    return 0;
  }
  Vec3 colour = colourOfNew(tissues_, name, label);
  if (colour == labelColour(label) && !like.empty()) colour = colourOfNew(tissues_, like, label);
  map_->structures.push_back({label, name, colour});
  return label;
}

}  // namespace trephine
