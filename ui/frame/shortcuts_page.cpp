#include "ui/frame/shortcuts_page.h"

#include <QDialogButtonBox>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QMenuBar>
#include <QRegularExpression>
#include <QSet>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "ui/common/making.h"
#include "ui/common/placing.h"

namespace trephine {

namespace {

QString plain(QString text) {
  return text.remove(QRegularExpression(QStringLiteral("&(?!&)"))).remove(QChar(0x2026));
}

// The tip without the key, which stands beside it.
QString meaning(const QAction& action) {
  QString tip = action.toolTip();
  const QString key = action.shortcut().toString(QKeySequence::NativeText);
  return tip.remove(QStringLiteral(" (%1)").arg(key));
}

QString keysOf(const QAction& action) {
  QStringList keys;
  for (const QKeySequence& one : action.shortcuts()) keys << one.toString(QKeySequence::NativeText);
  return keys.join(ShortcutsPage::tr(" or "));
}

void addRows(QTreeWidgetItem* group, const QList<QAction*>& actions, QSet<const QAction*>& listed) {
  for (const QAction* action : actions) {
    if (action->menu()) {
      addRows(group, action->menu()->actions(), listed);
    } else if (!action->shortcut().isEmpty() && !listed.contains(action)) {
      listed.insert(action);
      new QTreeWidgetItem(group, {plain(action->text()), keysOf(*action), meaning(*action)});
    }
  }
}

}  // namespace

ShortcutsPage::ShortcutsPage(const QMainWindow& window, const QList<QPair<QString, QString>>& views,
                             QWidget* parent)
    : QDialog(parent) {
  setObjectName("shortcutsPage");
  setWindowTitle(tr("Keys"));
  setAttribute(Qt::WA_DeleteOnClose);
  auto* list = named(new QTreeWidget, "shortcuts");
  list->setHeaderLabels({tr("What"), tr("Key"), tr("What it does")});
  list->setRootIsDecorated(false);
  list->setSelectionMode(QAbstractItemView::NoSelection);
  list->setWordWrap(true);
  // A row is as high as its words are in the width that they have then.
  connect(list->header(), &QHeaderView::sectionResized, list, [list] { list->doItemsLayout(); });
  const auto addGroup = [list](const QString& title) {
    auto* group = new QTreeWidgetItem(list, {title});
    QFont bold = list->font();
    bold.setBold(true);
    group->setFont(0, bold);
    group->setFirstColumnSpanned(true);
    return group;
  };
  QSet<const QAction*> listed;
  const auto addAll = [&](const QString& title, const QList<QAction*>& actions) {
    QTreeWidgetItem* group = addGroup(title);
    addRows(group, actions, listed);
    if (group->childCount() == 0) delete group;
  };
  for (const QAction* menu : window.menuBar()->actions()) {
    if (menu->menu()) addAll(plain(menu->text()), menu->menu()->actions());
  }
  addAll(tr("In lists and panels"), window.findChildren<QAction*>());
  for (const auto& [title, words] : views) {
    QTreeWidgetItem* group = addGroup(title);
    // "Key: what it does. Key: ..."
    for (QString part : words.split(QStringLiteral(". "), Qt::SkipEmptyParts)) {
      if (part.endsWith('.')) part.chop(1);
      const int colon = int(part.indexOf(QStringLiteral(": ")));
      new QTreeWidgetItem(group, colon < 0
                                     ? QStringList{part, {}, {}}
                                     : QStringList{{}, part.left(colon), part.mid(colon + 2)});
    }
  }
  list->expandAll();
  list->resizeColumnToContents(0);
  list->resizeColumnToContents(1);
  auto* find = named(new QLineEdit, "findKey");
  find->setPlaceholderText(tr("Find"));
  connect(find, &QLineEdit::textChanged, list, [list](const QString& wanted) {
    for (int i = 0; i < list->topLevelItemCount(); ++i) {
      QTreeWidgetItem* group = list->topLevelItem(i);
      bool any = false;
      for (int k = 0; k < group->childCount(); ++k) {
        QTreeWidgetItem* row = group->child(k);
        const QString all = row->text(0) + ' ' + row->text(1) + ' ' + row->text(2);
        const bool hit = all.contains(wanted, Qt::CaseInsensitive);
        row->setHidden(!hit);
        any = any || hit;
      }
      group->setHidden(!any);
    }
  });
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(find);
  layout->addWidget(list, 1);
  layout->addWidget(buttons);
  resize(sizeOnScreen({760, 620}, *this));
  find->setFocus();
}

}  // namespace trephine
