#include "ui/structures/structure_panel.h"

#include <QColorDialog>
#include <QFormLayout>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QSignalBlocker>
#include <algorithm>
#include <cmath>

#include "ui/common/colours.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kNameColumn = 0, kMlColumn = 1;
constexpr int kProgressSteps = 1000;
constexpr SliceTool kTools[] = {SliceTool::grow, SliceTool::brush, SliceTool::eraser,
                                SliceTool::piece};

QIcon swatch(const Vec3& colour) {
  QPixmap pixmap(16, 16);
  pixmap.fill(QColor::fromRgbF(float(colour.x), float(colour.y), float(colour.z)));
  return pixmap;
}

QLabel* words(const char* name, QWidget* parent) {
  auto* label = new QLabel(parent);
  label->setObjectName(name);
  label->setWordWrap(true);
  label->setTextFormat(Qt::PlainText);
  return label;
}

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
  connect(&editor_, &StructureEditor::listChanged, this, &StructurePanel::showList);
  connect(&editor_, &StructureEditor::stateChanged, this, &StructurePanel::showState);
  connect(&editor_, &StructureEditor::said, this, &StructurePanel::say);
  connect(&editor_, &StructureEditor::progressed, this, [this](double fraction, const QString&) {
    progress_->setValue(int(fraction * kProgressSteps));
  });
  showList();
  showState();
}

QToolButton* StructurePanel::button(const char* name, const QString& text, const QString& tip) {
  auto* made = new QToolButton(this);
  made->setObjectName(name);
  made->setText(text);
  made->setToolTip(tip);
  made->setFocusPolicy(Qt::TabFocus);
  made->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  return made;
}

void StructurePanel::build() {
  list_ = new QTreeWidget(this);
  list_->setObjectName("structureList");
  list_->setColumnCount(2);
  list_->setHeaderLabels({tr("Structure"), tr("mL")});
  list_->setRootIsDecorated(false);
  list_->setUniformRowHeights(true);
  list_->setEditTriggers(QAbstractItemView::EditKeyPressed);
  list_->header()->setStretchLastSection(false);
  list_->header()->setSectionResizeMode(kNameColumn, QHeaderView::Stretch);
  list_->header()->setSectionResizeMode(kMlColumn, QHeaderView::ResizeToContents);
  list_->setMinimumHeight(110);
  list_->setToolTip(tr("F2 renames, a double click on the colour changes it, Del deletes"));
  empty_ = words("structuresEmpty", this);
  empty_->setProperty("quiet", true);

  said_ = words("structureSaid", this);
  preview_box_ = new QWidget(this);
  preview_ = words("structurePreview", preview_box_);
  take_ = new QPushButton(tr("&Take it"), preview_box_);
  take_->setObjectName("takePreview");
  take_->setToolTip(tr("It counts from now on (Return in a slice)"));
  leave_ = new QPushButton(tr("&Leave it"), preview_box_);
  leave_->setObjectName("leavePreview");
  leave_->setToolTip(tr("It goes again (Esc in a slice)"));
  auto* preview_layout = new QGridLayout(preview_box_);
  preview_layout->setContentsMargins(0, 0, 0, 0);
  preview_layout->addWidget(preview_, 0, 0, 1, 2);
  preview_layout->addWidget(take_, 1, 0);
  preview_layout->addWidget(leave_, 1, 1);

  progress_box_ = new QWidget(this);
  progress_ = new QProgressBar(progress_box_);
  progress_->setObjectName("structureProgress");
  progress_->setRange(0, kProgressSteps);
  progress_->setTextVisible(false);
  progress_->setMaximumHeight(14);
  cancel_ = new QPushButton(tr("Cancel"), progress_box_);
  cancel_->setObjectName("cancelStructure");
  auto* progress_layout = new QHBoxLayout(progress_box_);
  progress_layout->setContentsMargins(0, 0, 0, 0);
  progress_layout->addWidget(progress_, 1);
  progress_layout->addWidget(cancel_);

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

  open_file_ = new QPushButton(tr("&Open segmentation\u2026"), this);
  open_file_->setObjectName("openSegmentation");
  open_file_->setToolTip(
      tr("Structures from elsewhere: DICOM SEG, 3D Slicer's .seg.nrrd, label maps with names"));
  save_ = new QPushButton(tr("&Save structures\u2026"), this);
  save_->setObjectName("saveStructures");
  connect(save_, &QPushButton::clicked, this, &StructurePanel::saveWanted);
  auto* others = new QPushButton(tr("E&xport"), this);
  others->setObjectName("exportStructures");
  others->setMenu(buildSaving());
  auto* files = new QHBoxLayout;
  files->addWidget(open_file_);
  files->addWidget(save_);
  files->addWidget(others);

  auto* called = new QFormLayout;
  called->addRow(tr("Next one"), name_);

  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(10, 10, 10, 10);
  layout->setSpacing(8);
  layout->addWidget(list_);
  layout->addWidget(empty_);
  layout->addLayout(steps);
  layout->addWidget(preview_box_);
  layout->addWidget(progress_box_);
  layout->addWidget(said_);
  layout->addLayout(called);
  layout->addLayout(buildTools());
  layout->addLayout(buildShaping());
  layout->addLayout(files);
  layout->addStretch(1);

  connect(list_, &QTreeWidget::currentItemChanged, this, [this](QTreeWidgetItem* item) {
    if (!listing_ && item) editor_.setCurrent(item->data(kNameColumn, Qt::UserRole).toInt());
  });
  connect(list_, &QTreeWidget::itemChanged, this, [this](QTreeWidgetItem* item) {
    if (!listing_) rename(item);
  });
  connect(list_, &QTreeWidget::itemDoubleClicked, this, [this](QTreeWidgetItem* item) {
    chooseColour(item->data(kNameColumn, Qt::UserRole).toInt());
  });
  connect(take_, &QPushButton::clicked, &editor_, &StructureEditor::takePreview);
  connect(leave_, &QPushButton::clicked, &editor_, &StructureEditor::leavePreview);
  connect(cancel_, &QPushButton::clicked, &editor_, &StructureEditor::cancel);
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
  tools_ = {button("structureGrow", tr("Grow"),
                   tr("Click into an organ: what hangs together with it is taken (G)")),
            button("structureBrush", tr("Brush"), tr("Paint the chosen structure (B)")),
            button("structureEraser", tr("Eraser"), tr("Take away from the chosen one (E)")),
            button("structurePiece", tr("Keep piece"),
                   tr("Click the piece that stays; the rest of the chosen one goes (P)"))};
  auto* row = new QGridLayout;
  row->setSpacing(4);
  for (int n = 0; n < 4; ++n) {
    QToolButton* tool = tools_[std::size_t(n)];
    tool->setCheckable(true);
    row->addWidget(tool, 0, n);
    connect(tool, &QToolButton::clicked, this,
            [this, n](bool on) { emit toolChosen(on ? kTools[n] : SliceTool::window); });
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
  brush_row->addLayout(radius_->withReason(), 1);
  brush_row->addWidget(shape_);
  auto* hu_row = new QHBoxLayout;
  hu_row->addWidget(only_hu_);
  hu_row->addLayout(hu_low_->withReason(), 1);
  hu_row->addLayout(hu_high_->withReason(), 1);
  auto* form = new QFormLayout;
  form->setVerticalSpacing(6);
  form->addRow(tr("Room for a ball"), open_->withReason());
  form->addRow(tr("Brush"), brush_row);
  auto* column = new QVBoxLayout;
  column->setSpacing(6);
  column->addLayout(row);
  column->addLayout(form);
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
  auto* grid = new QGridLayout;
  grid->setSpacing(4);
  grid->addWidget(skull_button_, 0, 0);
  grid->addWidget(fill_, 0, 1);
  int row = 1;
  for (const auto& [tool, field] :
       {std::pair{skin_button_, skin_}, std::pair{smooth_button_, smooth_},
        std::pair{shell_button_, shell_}}) {
    grid->addWidget(tool, row, 0);
    grid->addLayout(field->withReason(), row++, 1);
  }
  connect(skull_button_, &QToolButton::clicked, &editor_, &StructureEditor::makeSkull);
  connect(skin_button_, &QToolButton::clicked, this, &StructurePanel::makeSkin);
  connect(fill_, &QToolButton::clicked, &editor_, &StructureEditor::fillHoles);
  connect(smooth_button_, &QToolButton::clicked, this,
          [this] { editor_.smooth(smooth_->wanted()); });
  connect(shell_button_, &QToolButton::clicked, this, [this] {
    const std::shared_ptr<const LabelMap> map = editor_.map();
    const Structure* of = map ? map->find(editor_.current()) : nullptr;
    if (!of) return;
    const bool liver = sameName(of->name, "liver");
    editor_.makeShell(shell_->wanted(),
                      liver ? QStringLiteral("capsule") : tr("%1 shell").arg(toQt(of->name)));
  });
  return grid;
}

// --- What is chosen ---

void StructurePanel::setWanted(const std::vector<std::string>& names) {
  wanted_ = names;
  showList();
}

void StructurePanel::showTool(SliceTool tool) {
  tool_ = tool;
  for (std::size_t n = 0; n < tools_.size(); ++n) tools_[n]->setChecked(kTools[n] == tool);
  switch (tool) {
    case SliceTool::grow:
      say(tr("Click into the organ, well inside."));
      break;
    case SliceTool::brush:
    case SliceTool::eraser:
      say(tr("Drag in a slice; [ and ] change the size."));
      break;
    case SliceTool::piece:
      say(tr("Click the piece that stays."));
      break;
    default:
      say({});
  }
}

Brush StructurePanel::brush(SliceTool tool, int across) const {
  Brush brush;
  brush.shape = shape_->currentIndex() == 0 ? Brush::Shape::ball : Brush::Shape::disc;
  brush.radius_mm = radius_->wanted();
  brush.across = across;
  if (only_hu_->isChecked()) {
    brush.hu = HuSpan{double(hu_low_->wanted()), double(hu_high_->wanted())};
  }
  brush.erase = tool == SliceTool::eraser;
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
  if (renamed) return;
  say(toQt(renamed.error().what) + ". " + toQt(renamed.error().next) + ".");
  showList();
}

void StructurePanel::chooseColour(int label) {
  const std::shared_ptr<const LabelMap> map = editor_.map();
  const Structure* of = map ? map->find(label) : nullptr;
  if (!of) return;
  const Vec3 c = of->colour;
  auto* dialog = new QColorDialog(QColor::fromRgbF(float(c.x), float(c.y), float(c.z)), this);
  dialog->setObjectName("structureColour");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(tr("Colour of %1").arg(toQt(of->name)));
  connect(dialog, &QColorDialog::colorSelected, this, [this, label](const QColor& colour) {
    editor_.setColour(label, {colour.redF(), colour.greenF(), colour.blueF()});
  });
  dialog->open();
}

void StructurePanel::say(const QString& text) {
  said_->setText(text);
  said_->setVisible(!text.isEmpty());
}

// --- What is shown ---

void StructurePanel::showList() {
  listing_ = true;
  list_->clear();
  const std::shared_ptr<const LabelMap> map = editor_.map();
  std::vector<std::string> offered;
  for (const std::string& name : wanted_) {
    const Structure* there = map ? map->find(name) : nullptr;
    if (!there || editor_.millilitres(there->label) == 0.0) offered.push_back(name);
  }
  bool any = false;
  if (map) {
    for (const Structure& s : map->structures) {
      const double ml = editor_.millilitres(s.label);
      auto* item = new QTreeWidgetItem(list_);
      item->setText(kNameColumn, toQt(s.name));
      item->setIcon(kNameColumn, swatch(s.colour));
      item->setData(kNameColumn, Qt::UserRole, s.label);
      item->setFlags(item->flags() | Qt::ItemIsEditable);
      item->setText(kMlColumn, ml > 0.0 ? QString::number(ml, 'f', ml < 10.0 ? 2 : 0) : tr("none"));
      item->setTextAlignment(kMlColumn, Qt::AlignRight | Qt::AlignVCenter);
      if (editor_.preview() && editor_.preview()->label == s.label) {
        QFont font = item->font(kNameColumn);
        font.setItalic(true);
        item->setFont(kNameColumn, font);
      }
      if (s.label == editor_.current()) list_->setCurrentItem(item);
      any = true;
    }
  }
  list_->setVisible(any);
  empty_->setText(
      editor_.hasCase()
          ? tr("The case has no structures yet. Grow one by a click in a slice, or open "
               "a segmentation.")
          : tr("Open a case first."));
  empty_->setVisible(!any);
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
  showState();
}

void StructurePanel::showState() {
  const bool at_hand = editor_.hasCase(), busy = editor_.busy();
  const bool chosen = at_hand && editor_.current() != 0;
  for (QToolButton* tool : tools_) tool->setEnabled(at_hand);
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
      any = any || editor_.millilitres(s.label) > 0.0;
    }
  }
  save_->setEnabled(any && !busy && !editor_.preview());
  findChild<QPushButton*>("exportStructures")->setEnabled(save_->isEnabled());
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
    preview_->setText(text);
    colours::setText(*preview_, preview->leaked ? colours::kCaution : colours::kText);
    if (!only_hu_->isChecked()) {
      hu_low_->show(int(std::lround(preview->hu.low)));
      hu_high_->show(int(std::lround(preview->hu.high)));
    }
  }
}

}  // namespace trephine
