// How the panel of structures is put together.
#include <QAction>
#include <QFormLayout>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QMenu>
#include <QStackedLayout>
#include <algorithm>
#include <functional>

#include "ui/common/colours.h"
#include "ui/common/words.h"
#include "ui/structures/structure_tool.h"

namespace trephine {

namespace {

constexpr int kToolsInARow = 3;
constexpr int kNoticeLines = 5;

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
  list_->setColumnCount(3);
  list_->setHeaderLabels({tr("Structure"), tr("mL"), tr("Look")});
  list_->setRootIsDecorated(false);
  list_->setUniformRowHeights(true);
  list_->setEditTriggers(QAbstractItemView::EditKeyPressed | QAbstractItemView::DoubleClicked);
  list_->header()->setStretchLastSection(false);
  list_->header()->setSectionResizeMode(kNameColumn, QHeaderView::Stretch);
  list_->header()->setSectionResizeMode(kMlColumn, QHeaderView::ResizeToContents);
  list_->header()->setSectionResizeMode(kLookColumn, QHeaderView::ResizeToContents);
  list_->setMinimumHeight(96);
  list_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Ignored);
  list_->setToolTip(
      tr("A double click or F2 renames, the right button offers more; V, or a click under Look, "
         "shows, ghosts and hides it"));
  buildListMenu();
  look_ = new StructureLookRow(this);
  no_room_ = words("structureNoRoom", this);
  colours::setText(*no_room_, colours::kCaution);
  empty_ = words("structuresEmpty", this);
  empty_->setProperty("quiet", true);
  empty_->setAlignment(Qt::AlignTop);
  auto* listing = new QWidget(this);
  listing->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Ignored);
  listing->setMinimumHeight(96);
  listing_layout_ = new QStackedLayout(listing);
  listing_layout_->addWidget(list_);
  listing_layout_->addWidget(empty_);

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

  open_file_ = new QPushButton(tr("&Open\u2026"), this);
  open_file_->setObjectName("openSegmentation");
  open_file_->setToolTip(
      tr("Structures from elsewhere: DICOM SEG, 3D Slicer's .seg.nrrd, label maps with names"));
  save_ = new QPushButton(tr("&Save\u2026"), this);
  save_->setObjectName("saveStructures");
  save_->setToolTip(tr("Save structures as a label map with their names"));
  connect(save_, &QPushButton::clicked, this, &StructurePanel::saveWanted);
  export_ = new QPushButton(tr("E&xport"), this);
  export_->setObjectName("exportStructures");
  export_->setMenu(buildSaving());
  auto* files = new QHBoxLayout;
  for (QPushButton* b : {open_file_, save_, export_}) {
    b->setMinimumWidth(b->fontMetrics().horizontalAdvance(b->text()) + 24);  // no 80 pixels
    files->addWidget(b);
  }

  auto* called = new QFormLayout;
  called->addRow(tr("Next one"), name_);

  // What comes and goes has room of its own, so that no button moves under the pointer.
  auto* notices = new QWidget(this);
  notices->setMinimumHeight(kNoticeLines * fontMetrics().lineSpacing() +
                            take_->sizeHint().height());
  auto* notice_layout = new QVBoxLayout(notices);
  notice_layout->setContentsMargins(0, 0, 0, 0);
  notice_layout->setSpacing(4);
  buildBoxLine(notices);
  for (QWidget* part : {preview_box_, progress_box_, static_cast<QWidget*>(said_), box_line_}) {
    notice_layout->addWidget(part);
  }
  notice_layout->addStretch(1);
  QSizePolicy keeps = look_->sizePolicy();
  keeps.setRetainSizeWhenHidden(true);
  look_->setSizePolicy(keeps);

  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(10, 10, 10, 10);
  layout->setSpacing(8);
  // What grows takes room from the list alone, so that what lies below stays where it is.
  layout->addWidget(listing, 1);
  layout->addWidget(look_);
  layout->addWidget(no_room_);
  layout->addWidget(notices);
  layout->addLayout(steps);
  layout->addLayout(called);
  layout->addLayout(buildTools());
  layout->addLayout(buildShaping());
  layout->addLayout(files);

  connect(list_, &QTreeWidget::currentItemChanged, this, [this](QTreeWidgetItem* item) {
    if (!listing_ && item) editor_.setCurrent(item->data(kNameColumn, Qt::UserRole).toInt());
  });
  connect(list_, &QTreeWidget::itemChanged, this, [this](QTreeWidgetItem* item) {
    if (!listing_) rename(item);
  });
  connect(list_, &QTreeWidget::itemClicked, this, [this](QTreeWidgetItem* item, int column) {
    if (column == kLookColumn) nextLook(item->data(kNameColumn, Qt::UserRole).toInt());
  });
  connect(look_, &StructureLookRow::lookChosen, this,
          [this](TissueLook look) { emit lookWanted(editor_.current(), look); });
  connect(look_, &StructureLookRow::opacityChosen, this,
          [this](double per_mm) { emit opacityWanted(editor_.current(), per_mm); });
  connect(take_, &QPushButton::clicked, &editor_, &StructureEditor::takePreview);
  connect(leave_, &QPushButton::clicked, &editor_, &StructureEditor::leavePreview);
  for (QPushButton* decides : {take_, leave_}) {
    connect(decides, &QPushButton::clicked, this, &StructurePanel::decided);
  }
  connect(cancel_, &QPushButton::clicked, &editor_, &StructureEditor::cancel);
  connect(undo_, &QToolButton::clicked, &editor_, &StructureEditor::undo);
  connect(redo_, &QToolButton::clicked, &editor_, &StructureEditor::redo);
  connect(delete_, &QToolButton::clicked, this, [this] { editor_.remove(editor_.current()); });
  connect(open_file_, &QPushButton::clicked, this, &StructurePanel::openWanted);
}

void StructurePanel::buildListMenu() {
  const auto add = [&](const char* name, const QString& text, const QKeySequence& key,
                       std::function<void()> does) {
    auto* action = new QAction(text, list_);
    action->setObjectName(name);
    action->setShortcut(key);
    action->setShortcutContext(Qt::WidgetShortcut);
    connect(action, &QAction::triggered, this, std::move(does));
    list_->addAction(action);
  };
  list_->setContextMenuPolicy(Qt::ActionsContextMenu);
  add("renameStructure", tr("&Rename"), {}, [this] {
    if (QTreeWidgetItem* item = list_->currentItem()) list_->editItem(item, kNameColumn);
  });
  add("recolourStructure", tr("&Colour\u2026"), {}, [this] { chooseColour(editor_.current()); });
  add("lookOfStructure", tr("Show, &ghost or hide in 3-D"), Qt::Key_V, [this] { nextLook(); });
  add("deleteStructure", tr("&Delete"), Qt::Key_Delete,
      [this] { editor_.remove(editor_.current()); });
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

void StructurePanel::buildBoxLine(QWidget* parent) {
  box_line_ = new QWidget(parent);
  box_ = words("growBox", box_line_);
  no_box_ = new QPushButton(tr("No bo&x"), box_line_);
  no_box_->setObjectName("noGrowBox");
  auto* box_layout = new QHBoxLayout(box_line_);
  box_layout->setContentsMargins(0, 0, 0, 0);
  box_layout->addWidget(box_, 1);
  box_layout->addWidget(no_box_);
  connect(no_box_, &QPushButton::clicked, &editor_, &StructureEditor::leaveBox);
}

QLayout* StructurePanel::buildTools() {
  tools_ = {growTool(editor_, *this), brushTool(Stroke::wall, editor_, *this),
            pieceTool(editor_, *this), brushTool(Stroke::brush, editor_, *this),
            brushTool(Stroke::eraser, editor_, *this)};
  auto* row = new QGridLayout;
  row->setSpacing(4);
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
  auto* hu_row = new QHBoxLayout;
  hu_row->setSpacing(4);
  hu_row->addWidget(only_hu_);
  hu_row->addLayout(hu_low_->withReason(), 1);
  hu_row->addLayout(hu_high_->withReason(), 1);
  auto* form = new QFormLayout;
  form->addRow(tr("Room for a ball"), open_->withReason());
  auto* column = new QVBoxLayout;
  column->setSpacing(6);
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

}  // namespace trephine
