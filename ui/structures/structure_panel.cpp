#include "ui/structures/structure_panel.h"

#include <QSignalBlocker>
#include <algorithm>
#include <cmath>

#include "ui/common/words.h"
#include "ui/structures/structure_shaping.h"

namespace trephine {

StructurePanel::StructurePanel(StructureEditor& editor, QWidget* parent)
    : QWidget(parent), editor_(editor) {
  build();
  connect(&editor_, &StructureEditor::listChanged, this, [this] {
    showOffered();
    showState();
  });
  connect(&editor_, &StructureEditor::stateChanged, this, &StructurePanel::showState);
  showOffered();
  showState();
}

// --- What is chosen ---

void StructurePanel::setWanted(const std::vector<std::string>& names) {
  wanted_ = names;
  showOffered();
}

void StructurePanel::showTool(const ViewTool& tool) {
  for (std::size_t n = 0; n < tools_.size(); ++n) tool_buttons_[n]->setChecked(tools_[n] == &tool);
  notices_->setHint(holds(tool) ? tool.facts().hint : QString());
}

Brush StructurePanel::brush(bool erase, int across) const {
  Brush brush;
  brush.shape = shape_->currentIndex() == 0 ? Brush::Shape::ball : Brush::Shape::disc;
  brush.radius_mm = radius_->wanted();
  brush.across = across;
  if (only_hu_->isChecked()) {
    brush.hu = HuSpan{double(hu_low_->wanted()), double(hu_high_->wanted())};
  }
  brush.erase = erase;
  return brush;
}

GrowOptions StructurePanel::growing() const {
  GrowOptions options;
  options.open_mm = open_->wanted();
  if (only_hu_->isChecked()) {
    options.hu = HuSpan{double(hu_low_->wanted()), double(hu_high_->wanted())};
  }
  return options;
}

QString StructurePanel::name() const {
  return name_->currentText();
}

void StructurePanel::makeSkin() {
  trephine::makeSkin(editor_, skin_->wanted());
}

// Less than two voxels round nothing off.
void StructurePanel::suitVoxels(const Vec3& spacing_mm) {
  constexpr double kLeast_mm = 3.0;
  const double voxel_mm = std::max({spacing_mm.x, spacing_mm.y, spacing_mm.z});
  smooth_->show(std::max(kLeast_mm, std::ceil(4.0 * voxel_mm) / 2.0));
}

void StructurePanel::stepRadius(int steps) {
  radius_->stepBy(2 * steps);
}

// Another range or ball, while a preview stands: the same place once more.
void StructurePanel::regrow() {
  if (!editor_.preview() || editor_.busy()) return;
  const Structure* grown = editor_.structures().find(editor_.preview()->label);
  const QString called = grown ? toQt(grown->name) : name();
  editor_.growAt(editor_.preview()->seed_mm, called, growing());
}

void StructurePanel::offerWanted() {
  name_->setCurrentIndex(0);  // those come first
}

// --- What is shown ---

void StructurePanel::showOffered() {
  const std::shared_ptr<const LabelMap> map = editor_.map();
  std::vector<std::string> offered;
  for (const std::string& name : wanted_) {
    const Structure* there = map ? map->find(name) : nullptr;
    const bool grown = there && editor_.preview() && editor_.preview()->label == there->label;
    // What does not count yet is grown again under its name.
    if (!there || grown || editor_.millilitres(there->label) == 0.0) offered.push_back(name);
  }
  const QString typed = name_->currentText();
  bool was_offered = typed.isEmpty();
  for (int i = 0; i < name_->count(); ++i) was_offered = was_offered || name_->itemText(i) == typed;
  const QSignalBlocker quiet(name_);
  name_->clear();
  for (const std::string& name : offered) name_->addItem(toQt(name));
  name_->addItem(tr("structure"));
  if (!was_offered) name_->setEditText(typed);
}

void StructurePanel::showState() {
  const bool at_hand = editor_.hasCase(), busy = editor_.busy();
  const bool chosen = at_hand && editor_.current() != 0;
  for (QToolButton* tool : tool_buttons_) tool->setEnabled(at_hand);
  for (QToolButton* tool : {skull_button_, skin_button_}) tool->setEnabled(at_hand && !busy);
  for (QToolButton* tool : {fill_, smooth_button_, shell_button_, delete_}) {
    tool->setEnabled(chosen && !busy);
  }
  hu_low_->setEnabled(only_hu_->isChecked());
  hu_high_->setEnabled(only_hu_->isChecked());
  const auto undo = editor_.undoText(), redo = editor_.redoText();
  undo_->setEnabled(undo && !busy);
  redo_->setEnabled(redo && !busy);
  undo_->setToolTip(undo ? tr("Undo: %1 (Ctrl+Z)").arg(*undo) : tr("Nothing to undo"));
  redo_->setToolTip(redo ? tr("Redo: %1 (Ctrl+Shift+Z)").arg(*redo) : tr("Nothing to redo"));
  open_file_->setEnabled(at_hand && !busy);
  save_->setEnabled(editor_.hasAny() && !busy && !editor_.preview());
  export_->setEnabled(save_->isEnabled());
  surface_->setEnabled(editor_.millilitres(editor_.current()) > 0.0);
  const auto& preview = editor_.preview();
  if (preview && !only_hu_->isChecked()) {
    hu_low_->show(int(std::lround(preview->hu.low)));
    hu_high_->show(int(std::lround(preview->hu.high)));
  }
}

}  // namespace trephine
