#include "ui/structures/structure_panel.h"

#include <QAction>
#include <QFormLayout>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QMenu>
#include <QSignalBlocker>
#include <algorithm>
#include <cmath>
#include <functional>

#include "ui/common/making.h"
#include "ui/common/setting_words.h"
#include "ui/common/words.h"
#include "ui/structures/structure_shaping.h"
#include "ui/structures/structure_tool.h"

namespace trephine {

namespace {

constexpr int kToolsInARow = 3;

DecimalField* millimetres(const char* name, double value, double low, double high,
                          QWidget* parent) {
  auto* field = new DecimalField(name, parent);
  field->setDecimals(1);
  field->setSingleStep(0.5);
  field->setSuffix(QObject::tr(" mm"));
  field->setLimits(low, high);
  field->show(value);
  return field;
}

}  // namespace

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

// --- How it is put together ---

QToolButton* StructurePanel::button(const char* name, const QString& text, const QString& tip) {
  QToolButton* made = settingButton(name, text, tip, this);
  made->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  return made;
}

void StructurePanel::build() {
  list_ = new StructureList(editor_, this);
  notices_ = new StructureNotices(editor_, this);
  name_ = new QComboBox(this);
  name_->setObjectName("structureName");
  name_->setEditable(true);
  name_->setInsertPolicy(QComboBox::NoInsert);
  name_->setToolTip(tr("What is made next is called this"));
  name_->setAccessibleName(tr("Name of the next structure"));

  undo_ = button("structureUndo", tr("Undo"), tr("Take the last step back (Ctrl+Z)"));
  redo_ = button("structureRedo", tr("Redo"), tr("Do it again (Ctrl+Shift+Z)"));
  delete_ = button("structureDelete", tr("Delete"), tr("Take the chosen structure away (Del)"));
  auto* steps = new QHBoxLayout;
  for (QToolButton* b : {undo_, redo_, delete_}) steps->addWidget(b);

  open_file_ = namedButton("openSegmentation", tr("&Open\u2026"), false, this);
  open_file_->setToolTip(
      tr("Structures from elsewhere: DICOM SEG, 3D Slicer's .seg.nrrd, label maps with names"));
  save_ = namedButton("saveStructures", tr("&Save"), false, this);
  save_->setToolTip(
      tr("Save the structures in the case, or where the case is no one of the "
         "library's, as a label map with their names"));
  connect(save_, &QPushButton::clicked, this, &StructurePanel::keepWanted);
  export_ = namedButton("exportStructures", tr("E&xport"), false, this);
  export_->setMenu(buildSaving());
  auto* files = new QHBoxLayout;
  for (QPushButton* b : {open_file_, save_, export_}) {
    b->setMinimumWidth(b->fontMetrics().horizontalAdvance(b->text()) + 24);  // no 80 pixels
    files->addWidget(b);
  }

  auto* called = new QFormLayout;
  called->addRow(tr("Next one"), name_);

  auto* layout = tight(new QVBoxLayout(this), 8, {10, 10, 10, 10});
  // What grows takes room from the list alone, so that what lies below stays where it is.
  layout->addWidget(list_, 1);
  layout->addWidget(notices_);
  layout->addLayout(steps);
  layout->addLayout(called);
  layout->addLayout(buildTools());
  layout->addLayout(buildShaping());
  layout->addLayout(files);

  connect(list_, &StructureList::refused, notices_, &StructureNotices::say);
  connect(undo_, &QToolButton::clicked, &editor_, &StructureEditor::undo);
  connect(redo_, &QToolButton::clicked, &editor_, &StructureEditor::redo);
  connect(delete_, &QToolButton::clicked, this, [this] { editor_.remove(editor_.current()); });
  connect(open_file_, &QPushButton::clicked, this, &StructurePanel::openWanted);
}

QMenu* StructurePanel::buildSaving() {
  auto* menu = new QMenu(this);
  const auto add = [&](const char* name, const QString& text, const QString& tip,
                       void (StructurePanel::*wanted)()) {
    QAction* action = menu->addAction(text);
    action->setObjectName(name);
    action->setToolTip(tip);
    connect(action, &QAction::triggered, this, wanted);
    return action;
  };
  menu->setToolTipsVisible(true);
  add("saveLabelMap", tr("&Label map\u2026"), tr("With names, as Trephine and 3D Slicer open it"),
      &StructurePanel::saveWanted);
  add("saveDicom", tr("&DICOM folder\u2026"),
      tr("A DICOM SEG with its CT, under new UIDs and of nobody"),
      &StructurePanel::saveDicomWanted);
  for_source_ = add("saveForSource", tr("DICOM for the &original CT\u2026"),
                    tr("A DICOM SEG alone, which names the UIDs of the CT that was opened"),
                    &StructurePanel::saveForSourceWanted);
  surface_ = add("saveSurface", tr("&Surface of the chosen one (STL)\u2026"),
                 tr("For a printer or a drawing program"), &StructurePanel::saveSurfaceWanted);
  for_source_->setEnabled(false);
  return menu;
}

QLayout* StructurePanel::buildTools() {
  tools_ = {growTool(editor_, *this), brushTool(Stroke::wall, editor_, *this),
            pieceTool(editor_, *this), brushTool(Stroke::brush, editor_, *this),
            brushTool(Stroke::eraser, editor_, *this)};
  auto* row = tight(new QGridLayout, 4);
  for (int n = 0; n < int(tools_.size()); ++n) {
    ViewTool* tool = tools_[std::size_t(n)];
    QToolButton* taken = button(tool->facts().name, tool->facts().text, tool->facts().tip);
    taken->setCheckable(true);
    row->addWidget(taken, n / kToolsInARow, n % kToolsInARow);
    connect(taken, &QToolButton::clicked, this,
            [this, tool](bool on) { emit toolChosen(on ? tool : nullptr); });
    tool_buttons_[std::size_t(n)] = taken;
  }
  open_ = millimetres("growOpen", GrowOptions().open_mm, 0.0, 50.0, this);
  open_->setToolTip(
      tr("A ball of this radius has room all over in what is grown: larger holds it "
         "back at narrow bridges"));
  radius_ = millimetres("brushRadius", 6.0, 0.3, 60.0, this);
  radius_->setToolTip(tr("Of the brush and the eraser ([ and ] in a slice)"));
  shape_ = new QComboBox(this);
  shape_->setObjectName("brushShape");
  shape_->addItems({tr("Ball"), tr("Disc")});
  shape_->setToolTip(tr("A ball reaches into the slices beside; a disc stays in one"));
  only_hu_ = new QCheckBox(tr("Only HU"), this);
  only_hu_->setObjectName("onlyHu");
  only_hu_->setToolTip(
      tr("Grow: this range instead of the one proposed. Brush and eraser: no voxel "
         "outside of it"));
  hu_low_ = new WholeNumberField("structureHuLow", this);
  hu_high_ = new WholeNumberField("structureHuHigh", this);
  hu_low_->show(0);
  hu_high_->show(100);
  for (WholeNumberField* field : {hu_low_, hu_high_}) {
    field->setLimits(-1024, 3071);
    field->setSingleStep(5);
    field->entered = [this, field] {
      field->take();
      regrow();
    };
  }
  open_->entered = [this] {
    open_->take();
    regrow();
  };
  radius_->entered = [this] {
    radius_->take();
    emit brushChanged();
  };
  connect(only_hu_, &QCheckBox::toggled, this, [this] {
    showState();
    regrow();
  });
  connect(shape_, &QComboBox::activated, this, &StructurePanel::brushChanged);
  auto* brush_row = new QHBoxLayout;
  brush_row->addWidget(new QLabel(tr("Brush radius"), this));
  brush_row->addLayout(radius_->withReason(), 1);
  brush_row->addWidget(shape_);
  auto* hu_row = tight(new QHBoxLayout, 4);
  hu_row->addWidget(only_hu_);
  hu_row->addLayout(hu_low_->withReason(), 1);
  hu_row->addLayout(hu_high_->withReason(), 1);
  auto* form = new QFormLayout;
  form->addRow(tr("Room for a ball"), open_->withReason());
  auto* column = tight(new QVBoxLayout, 6);
  column->addLayout(row);
  column->addLayout(form);
  column->addLayout(brush_row);
  column->addLayout(hu_row);
  return column;
}

QLayout* StructurePanel::buildShaping() {
  skull_button_ = button("structureSkull", tr("Skull"),
                         tr("The skull of a head, without scalp, brain and table (K)"));
  skin_button_ = button("structureSkin", tr("Skin"), tr("The body's surface, this thick (S)"));
  fill_ = button("structureFill", tr("Fill holes"), tr("What the chosen one encloses joins it"));
  smooth_button_ = button("structureSmooth", tr("Smooth"), tr("Rounds off what is smaller"));
  shell_button_ = button("structureShell", tr("Shell"),
                         tr("The outermost layer of the chosen one becomes one of its own: a "
                            "capsule, an outer table"));
  skin_ = millimetres("skinThickness", 2.0, 0.5, 20.0, this);
  smooth_ = millimetres("smoothRadius", 3.0, 0.5, 20.0, this);
  shell_ = millimetres("shellThickness", 1.0, 0.1, 20.0, this);
  for (DecimalField* field : {skin_, smooth_, shell_}) field->entered = [field] { field->take(); };
  auto* grid = tight(new QGridLayout, 4);
  grid->addWidget(skull_button_, 0, 0);
  grid->addWidget(fill_, 0, 1);
  int row = 1;
  for (const auto& [tool, field] :
       {std::pair{skin_button_, skin_}, std::pair{smooth_button_, smooth_},
        std::pair{shell_button_, shell_}}) {
    grid->addWidget(tool, row, 0);
    grid->addLayout(field->withReason(), row++, 1);
  }
  connect(skull_button_, &QToolButton::clicked, this, [this] { makeSkull(editor_); });
  connect(skin_button_, &QToolButton::clicked, this, &StructurePanel::makeSkin);
  connect(fill_, &QToolButton::clicked, this, [this] { fillHoles(editor_); });
  connect(smooth_button_, &QToolButton::clicked, this,
          [this] { smooth(editor_, smooth_->wanted()); });
  connect(shell_button_, &QToolButton::clicked, this, [this] {
    const Structure* of = editor_.structures().find(editor_.current());
    if (!of) return;
    const bool liver = sameName(of->name, "liver");
    makeShell(editor_, shell_->wanted(),
              liver ? QStringLiteral("capsule") : tr("%1 shell").arg(toQt(of->name)));
  });
  return grid;
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

std::optional<HuSpan> StructurePanel::onlyHu() const {
  if (!only_hu_->isChecked()) return {};
  return HuSpan{double(hu_low_->wanted()), double(hu_high_->wanted())};
}

Brush StructurePanel::brush(bool erase, int across) const {
  Brush brush;
  brush.shape = shape_->currentIndex() == 0 ? Brush::Shape::ball : Brush::Shape::disc;
  brush.radius_mm = radius_->wanted();
  brush.across = across;
  brush.hu = onlyHu();
  brush.erase = erase;
  return brush;
}

GrowOptions StructurePanel::growing() const {
  GrowOptions options;
  options.open_mm = open_->wanted();
  options.hu = onlyHu();
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
