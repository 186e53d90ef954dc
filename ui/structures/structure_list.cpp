#include "ui/structures/structure_list.h"

#include <QAction>
#include <QColorDialog>
#include <QHeaderView>
#include <QMouseEvent>
#include <QVBoxLayout>
#include <functional>

#include "ui/common/colours.h"
#include "ui/common/making.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kNameColumn = 0, kMlColumn = 1, kLookColumn = 2;
constexpr int kLeastHeight = 96;

int labelOf(const QTreeWidgetItem* item) {
  return item->data(kNameColumn, Qt::UserRole).toInt();
}

QIcon swatch(const Vec3& colour) {
  QPixmap pixmap(16, 16);
  pixmap.fill(colours::of(colour));
  QIcon icon(pixmap);
  icon.addPixmap(pixmap, QIcon::Selected);  // a colour must not change by being chosen
  return icon;
}

}  // namespace

StructureList::StructureList(StructureEditor& editor, QWidget* parent)
    : QWidget(parent), editor_(editor) {
  buildList();
  look_ = new StructureLookRow(this);
  QSizePolicy keeps = look_->sizePolicy();
  keeps.setRetainSizeWhenHidden(true);
  look_->setSizePolicy(keeps);
  no_room_ = wrappedLabel("structureNoRoom");
  colours::setText(*no_room_, colours::kCaution);
  empty_ = wrappedLabel("structuresEmpty", {"quiet"});
  empty_->setAlignment(Qt::AlignTop);
  auto* listing = new QWidget(this);
  listing->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Ignored);
  listing->setMinimumHeight(kLeastHeight);
  listing_ = new QStackedLayout(listing);
  listing_->addWidget(list_);
  listing_->addWidget(empty_);
  auto* layout = tight(new QVBoxLayout(this), 8);
  layout->addWidget(listing, 1);
  layout->addWidget(look_);
  layout->addWidget(no_room_);
  connect(look_, &StructureLookRow::lookChosen, this,
          [this](TissueLook look) { emit lookWanted(editor_.current(), look); });
  connect(look_, &StructureLookRow::opacityChosen, this,
          [this](double per_mm) { emit opacityWanted(editor_.current(), per_mm); });
  connect(&editor_, &StructureEditor::listChanged, this, &StructureList::showList);
  showList();
}

void StructureList::buildList() {
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
  list_->setMinimumHeight(kLeastHeight);
  list_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Ignored);
  list_->setToolTip(
      tr("A double click or F2 renames, a click on the colour changes it, the right button offers "
         "more; V, or a click under Look, "
         "shows, ghosts and hides it"));
  buildMenu();
  connect(list_, &QTreeWidget::currentItemChanged, this, [this](QTreeWidgetItem* item) {
    if (!filling_ && item) editor_.setCurrent(labelOf(item));
  });
  connect(list_, &QTreeWidget::itemChanged, this, [this](QTreeWidgetItem* item) {
    if (!filling_) rename(item);
  });
  list_->viewport()->installEventFilter(this);
  connect(list_, &QTreeWidget::itemClicked, this, [this](QTreeWidgetItem* item, int column) {
    if (column == kLookColumn) return nextLook(labelOf(item));
    const int within = pressed_at_.x() - list_->visualItemRect(item).left();
    const int swatch = list_->style()->pixelMetric(QStyle::PM_SmallIconSize);
    if (column == kNameColumn && within >= 0 && within < swatch + 6) chooseColour();
  });
}

bool StructureList::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::MouseButtonPress) {
    pressed_at_ = static_cast<QMouseEvent*>(event)->pos();
  }
  return QWidget::eventFilter(watched, event);
}

void StructureList::buildMenu() {
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
  add("recolourStructure", tr("&Colour\u2026"), {}, [this] { chooseColour(); });
  add("lookOfStructure", tr("Show, &ghost or hide in 3-D"), Qt::Key_V, [this] { nextLook(); });
  add("deleteStructure", tr("&Delete"), Qt::Key_Delete,
      [this] { editor_.remove(editor_.current()); });
}

void StructureList::rename(QTreeWidgetItem* item) {
  const Status renamed = editor_.rename(labelOf(item), item->text(kNameColumn));
  if (!renamed) {
    emit refused(toQt(renamed.error().what) + ". " + toQt(renamed.error().next) + ".");
  }
  showList();  // where it may not change now, the old one
}

void StructureList::chooseColour() {
  const int label = editor_.current();
  const Structure* of = editor_.structures().find(label);
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

void StructureList::showList() {
  filling_ = true;
  const std::shared_ptr<const LabelMap> map = editor_.map();
  // What was deleted or undone has a row in the map alone, for its undo.
  std::vector<Structure> shown;
  for (const Structure& s : map ? map->structures : std::vector<Structure>{}) {
    if (editor_.millilitres(s.label) > 0.0) shown.push_back(s);
  }
  const int rows = int(shown.size());
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
  listing_->setCurrentWidget(rows > 0 ? static_cast<QWidget*>(list_) : empty_);
  empty_->setText(
      editor_.hasCase()
          ? tr("The case has no structures yet. Grow one by a click in a slice, or open "
               "a segmentation.")
          : tr("Open a case first."));
  filling_ = false;
  showLooks();
}

// --- How the 3-D view shows them ---

std::optional<SeenStructure> StructureList::seen(int label) const {
  for (const SeenStructure& s : seen_) {
    if (s.label == label) return s;
  }
  return {};
}

void StructureList::showLooks(const std::vector<SeenStructure>& seen) {
  seen_ = seen;
  showLooks();
}

void StructureList::showLooks() {
  filling_ = true;
  QStringList without;
  for (int row = 0; row < list_->topLevelItemCount(); ++row) {
    QTreeWidgetItem* item = list_->topLevelItem(row);
    const auto of = seen(labelOf(item));
    item->setText(kLookColumn, of ? StructureLookRow::wordOf(*of) : QString());
    if (of && !of->takesLook()) without << item->text(kNameColumn);
  }
  filling_ = false;
  const Structure* chosen = editor_.structures().find(editor_.current());
  look_->show(chosen ? toQt(chosen->name) : QString(), seen(editor_.current()));
  look_->setVisible(chosen != nullptr);
  constexpr int kMost = 3;
  QString names = QStringList(without.mid(0, kMost)).join(tr(", ", "between structures"));
  if (without.size() > kMost) names += tr(" and %1 more").arg(without.size() - kMost);
  no_room_->setText(
      tr("Beyond the %1 that a 3-D picture tells apart: %2. The chosen one is seen; hide "
         "others to see more.")
          .arg(kMaxTissues)
          .arg(names));
  no_room_->setVisible(!without.isEmpty());
}

void StructureList::nextLook(int label) {
  const auto of = seen(label);
  if (of && of->takesLook()) emit lookWanted(label, StructureLookRow::after(of->look));
}

}  // namespace trephine
