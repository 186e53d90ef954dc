#include "ui/structures/structure_panel.h"

#include <QColorDialog>
#include <QSignalBlocker>
#include <algorithm>
#include <cmath>

#include "ui/common/colours.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

QIcon swatch(const Vec3& colour) {
  QPixmap pixmap(16, 16);
  pixmap.fill(colours::of(colour));
  QIcon icon(pixmap);
  icon.addPixmap(pixmap, QIcon::Selected);  // a colour must not change by being chosen
  return icon;
}

}  // namespace

StructurePanel::StructurePanel(StructureEditor& editor, QWidget* parent)
    : QWidget(parent), editor_(editor) {
  build();
  connect(&editor_, &StructureEditor::listChanged, this, &StructurePanel::showList);
  connect(&editor_, &StructureEditor::stateChanged, this, &StructurePanel::showState);
  connect(&editor_, &StructureEditor::boxChanged, this, &StructurePanel::showBox);
  connect(&editor_, &StructureEditor::said, this, &StructurePanel::say);
  connect(&editor_, &StructureEditor::saidNoMore, this, [this](const QString& words) {
    if (said_->text() == words) say({});
  });
  connect(&editor_, &StructureEditor::progressed, this, [this](double fraction, const QString&) {
    progress_->setValue(int(fraction * kProgressSteps));
  });
  showList();
  showState();
  showBox();
}

// --- What is chosen ---

void StructurePanel::setWanted(const std::vector<std::string>& names) {
  wanted_ = names;
  showList();
}

void StructurePanel::showTool(const ViewTool& tool) {
  for (std::size_t n = 0; n < tools_.size(); ++n) tool_buttons_[n]->setChecked(tools_[n] == &tool);
  hint_ = holds(tool) ? tool.facts().hint : QString();
  say({});
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
  editor_.makeSkin(skin_->wanted());
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
  const Structure* grown = editor_.map()->find(editor_.preview()->label);
  const QString called = grown ? toQt(grown->name) : name();
  editor_.growAt(editor_.preview()->seed_mm, called, growing());
}

void StructurePanel::rename(QTreeWidgetItem* item) {
  const int label = item->data(kNameColumn, Qt::UserRole).toInt();
  const Status renamed = editor_.rename(label, item->text(kNameColumn));
  if (renamed) return showList();  // where it may not change now, the old one
  say(toQt(renamed.error().what) + ". " + toQt(renamed.error().next) + ".");
  showList();
}

void StructurePanel::chooseColour(int label) {
  const std::shared_ptr<const LabelMap> map = editor_.map();
  const Structure* of = map ? map->find(label) : nullptr;
  if (!of) return;
  auto* dialog = new QColorDialog(colours::of(of->colour), this);
  dialog->setObjectName("structureColour");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(tr("Colour of %1").arg(toQt(of->name)));
  connect(dialog, &QColorDialog::colorSelected, this, [this, label](const QColor& colour) {
    const Vec3 chosen = colours::rgbOf(colour);
    if (editor_.setColour(label, chosen)) emit colourChosen(label, chosen);
  });
  dialog->open();
}

void StructurePanel::say(const QString& text) {
  said_->setText(text.isEmpty() ? hint_ : text);
}

void StructurePanel::offerWanted() {
  name_->setCurrentIndex(0);  // those come first
}

// --- What is shown ---

void StructurePanel::showBox() {
  const std::optional<Vec3> mm = editor_.boxSize_mm();
  box_line_->setVisible(mm.has_value());
  if (!mm) return;
  QStringList sides;
  for (int axis = 0; axis < 3; ++axis) sides << QString::number((*mm)[axis], 'f', 0);
  box_->setText(tr("Grows inside of a box of %1 mm").arg(sides.join(QStringLiteral(" \u00d7 "))));
}

void StructurePanel::showList() {
  listing_ = true;
  const std::shared_ptr<const LabelMap> map = editor_.map();
  std::vector<std::string> offered;
  for (const std::string& name : wanted_) {
    const Structure* there = map ? map->find(name) : nullptr;
    const bool grown = there && editor_.preview() && editor_.preview()->label == there->label;
    // What does not count yet is grown again under its name.
    if (!there || grown || editor_.millilitres(there->label) == 0.0) offered.push_back(name);
  }
  // What was deleted or undone has a row in the map alone, for its undo.
  std::vector<Structure> shown;
  for (const Structure& s : map ? map->structures : std::vector<Structure>{}) {
    if (editor_.millilitres(s.label) > 0.0) shown.push_back(s);
  }
  const int rows = int(shown.size());
  const bool any = rows > 0;
  while (list_->topLevelItemCount() > rows) delete list_->takeTopLevelItem(rows);
  while (list_->topLevelItemCount() < rows) new QTreeWidgetItem(list_);
  for (int row = 0; row < rows; ++row) {
    const Structure& s = shown[std::size_t(row)];
    const double ml = editor_.millilitres(s.label);
    QTreeWidgetItem* item = list_->topLevelItem(row);
    item->setText(kNameColumn, toQt(s.name));
    item->setIcon(kNameColumn, swatch(s.colour));
    item->setData(kNameColumn, Qt::UserRole, s.label);
    item->setFlags(item->flags() | Qt::ItemIsEditable);
    item->setText(kMlColumn, QString::number(ml, 'f', ml < 10.0 ? 2 : 0));
    item->setTextAlignment(kMlColumn, Qt::AlignRight | Qt::AlignVCenter);
    QFont font = item->font(kNameColumn);
    font.setItalic(editor_.preview() && editor_.preview()->label == s.label);
    item->setFont(kNameColumn, font);
    if (s.label == editor_.current()) list_->setCurrentItem(item);
  }
  listing_layout_->setCurrentWidget(any ? static_cast<QWidget*>(list_) : empty_);
  empty_->setText(
      editor_.hasCase()
          ? tr("The case has no structures yet. Grow one by a click in a slice, or open "
               "a segmentation.")
          : tr("Open a case first."));
  const QString typed = name_->currentText();
  bool was_offered = typed.isEmpty();
  for (int i = 0; i < name_->count(); ++i) was_offered = was_offered || name_->itemText(i) == typed;
  {
    const QSignalBlocker quiet(name_);
    name_->clear();
    for (const std::string& name : offered) name_->addItem(toQt(name));
    name_->addItem(tr("structure"));
    if (!was_offered) name_->setEditText(typed);
  }
  listing_ = false;
  showLooks();
  showState();
}

// --- How the 3-D view shows them ---

std::optional<SeenStructure> StructurePanel::seen(int label) const {
  for (const SeenStructure& s : seen_) {
    if (s.label == label) return s;
  }
  return {};
}

void StructurePanel::showLooks(const std::vector<SeenStructure>& seen) {
  seen_ = seen;
  showLooks();
}

void StructurePanel::showLooks() {
  const std::shared_ptr<const LabelMap> map = editor_.map();
  listing_ = true;
  QStringList without;
  for (int row = 0; row < list_->topLevelItemCount(); ++row) {
    QTreeWidgetItem* item = list_->topLevelItem(row);
    const auto of = seen(item->data(kNameColumn, Qt::UserRole).toInt());
    item->setText(kLookColumn, of ? StructureLookRow::wordOf(*of) : QString());
    if (of && !of->has_room) without << item->text(kNameColumn);
  }
  listing_ = false;
  const Structure* chosen = map ? map->find(editor_.current()) : nullptr;
  look_->show(chosen ? toQt(chosen->name) : QString(), seen(editor_.current()));
  look_->setVisible(chosen != nullptr);
  constexpr int kMost = 3;
  QString names = QStringList(without.mid(0, kMost)).join(tr(", ", "between structures"));
  if (without.size() > kMost) names += tr(" and %1 more").arg(without.size() - kMost);
  no_room_->setText(tr("A 3-D picture tells %1 tissues and structures apart: %2 has no room. Hide "
                       "others to see it.")
                        .arg(kMaxTissues)
                        .arg(names));
  no_room_->setVisible(!without.isEmpty());
}

void StructurePanel::nextLook() {
  nextLook(editor_.current());
}

void StructurePanel::nextLook(int label) {
  const auto of = seen(label);
  if (of && of->has_room) emit lookWanted(label, StructureLookRow::after(of->look));
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
  progress_box_->setVisible(busy);
  if (!busy) progress_->setValue(0);
  open_file_->setEnabled(at_hand && !busy);
  bool any = false;
  if (const std::shared_ptr<const LabelMap> map = editor_.map()) {
    for (const Structure& s : map->structures) {
      any = any || (s.label != editor_.wall() && editor_.millilitres(s.label) > 0.0);
    }
  }
  save_->setEnabled(any && !busy && !editor_.preview());
  export_->setEnabled(save_->isEnabled());
  surface_->setEnabled(editor_.millilitres(editor_.current()) > 0.0);
  const auto& preview = editor_.preview();
  preview_box_->setVisible(preview.has_value());
  if (preview) {
    QString text = tr("%1 mL, of about %2 to %3 HU.")
                       .arg(preview->ml, 0, 'f', 0)
                       .arg(preview->hu.low, 0, 'f', 0)
                       .arg(preview->hu.high, 0, 'f', 0);
    if (preview->leaked) {
      text += ' ' + tr("It reaches the border of the scan or fills much of it: look whether it is "
                       "the organ alone. A larger ball or a range of HU holds it back.");
    }
    if (preview->seed_off_mm > 0.0) {
      text += ' ' + tr("The place that was clicked lies %1 mm beside it.")
                        .arg(preview->seed_off_mm, 0, 'f', 1);
    }
    preview_->setText(text);
    const bool doubtful = preview->leaked || preview->seed_off_mm > 0.0;
    colours::setText(*preview_, doubtful ? colours::kCaution : colours::kText);
    if (!only_hu_->isChecked()) {
      hu_low_->show(int(std::lround(preview->hu.low)));
      hu_high_->show(int(std::lround(preview->hu.high)));
    }
  }
}

}  // namespace trephine
