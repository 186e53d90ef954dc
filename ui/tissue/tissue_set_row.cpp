#include "ui/tissue/tissue_set_row.h"

#include <QHBoxLayout>

#include "base/utf8.h"
#include "ui/common/icons.h"
#include "ui/common/making.h"
#include "ui/common/setting_words.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kMostLetters = 60;

QToolButton* smallButton(const char* name, Symbol symbol, const QString& tip, QWidget* parent) {
  QToolButton* button = settingButton(name, {}, tip, parent);
  button->setIcon(symbolIcon(symbol));
  button->setAccessibleName(tip);
  button->setAutoRaise(true);
  return button;
}

}  // namespace

TissueSetRow::TissueSetRow(QWidget* parent) : QWidget(parent) {
  name_ = new QLineEdit(this);
  name_->setObjectName("setName");
  name_->setAccessibleName(tr("Name of the tissue set"));
  name_->setToolTip(tr("What this set of tissues is called"));
  name_->setMaxLength(kMostLetters);
  connect(name_, &QLineEdit::editingFinished, this, &TissueSetRow::nameEntered);
  menu_ = settingButton("setMenu", tr("&Set"),
                        tr("New, duplicate, import, export, revert; the sets of this workstation"),
                        this);
  menu_->setPopupMode(QToolButton::InstantPopup);
  menu_->setMenu(buildMenu());
  undo_ = smallButton("undoEdit", Symbol::undo, tr("Takes back the last edit"), this);
  redo_ = smallButton("redoEdit", Symbol::redo, tr("Does it again"), this);
  connect(undo_, &QToolButton::clicked, this, &TissueSetRow::undoWanted);
  connect(redo_, &QToolButton::clicked, this, &TissueSetRow::redoWanted);
  auto* row = tight(new QHBoxLayout(this), 4);
  row->addWidget(name_, 1);
  row->addWidget(menu_);
  row->addWidget(undo_);
  row->addWidget(redo_);
}

QMenu* TissueSetRow::buildMenu() {
  auto* menu = new QMenu(menu_);
  const auto add = [&](const char* name, const QString& text, void (TissueSetRow::*wanted)()) {
    QAction* action = menu->addAction(text, this, wanted);
    action->setObjectName(name);
  };
  add("newSet", tr("&New"), &TissueSetRow::newSetWanted);
  add("duplicateSet", tr("&Duplicate"), &TissueSetRow::duplicateWanted);
  sets_ = menu->addMenu(tr("&Take another"));
  sets_->setObjectName("setsMenu");
  add("importSet", tr("&Import\u2026"), &TissueSetRow::importWanted);
  add("exportSet", tr("&Export\u2026"), &TissueSetRow::exportWanted);
  add("revertSet", tr("&Revert"), &TissueSetRow::revertWanted);
  connect(menu, &QMenu::aboutToShow, this, &TissueSetRow::setsWanted);
  return menu;
}

void TissueSetRow::nameEntered() {
  const std::string typed = cleanUtf8(name_->text().toStdString());
  name_->setModified(false);
  if (typed.empty() || typed == shown_) return show(shown_);
  emit renamed(typed);
}

void TissueSetRow::show(const std::string& name) {
  shown_ = name;
  name_->setText(toQt(name));
}

void TissueSetRow::setOpen(bool open) {
  name_->setEnabled(open);
  menu_->setEnabled(open);
}

void TissueSetRow::setSets(const std::vector<std::pair<QString, std::filesystem::path>>& sets) {
  sets_->clear();
  for (const auto& [name, file] : sets) {
    sets_->addAction(name, this, [this, file = file] { emit setWanted(file); });
  }
  sets_->setEnabled(!sets.empty());
}

void TissueSetRow::showHistory(const QString& undo, const QString& redo) {
  undo_->setEnabled(!undo.isEmpty());
  redo_->setEnabled(!redo.isEmpty());
}

}  // namespace trephine
