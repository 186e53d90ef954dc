#include "ui/structures/overlap_dialog.h"

#include <QDialogButtonBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QShortcut>
#include <QVBoxLayout>

#include "ui/common/words.h"

namespace trephine {

OverlapDialog::OverlapDialog(const std::vector<std::string>& names, QWidget* parent)
    : QDialog(parent) {
  setObjectName("overlapQuestion");
  setAttribute(Qt::WA_DeleteOnClose);
  setWindowTitle(tr("Structures that overlap"));
  auto* words = new QLabel(tr("These structures of the file share voxels. Where they do, the one "
                              "that stands higher has them."),
                           this);
  words->setWordWrap(true);
  list_ = new QListWidget(this);
  list_->setObjectName("overlapOrder");
  list_->setAccessibleName(tr("Order of the structures"));
  for (const std::string& name : names) list_->addItem(toQt(name));
  list_->setCurrentRow(0);
  up_ = new QPushButton(tr("Move &up"), this);
  up_->setObjectName("overlapUp");
  up_->setToolTip(tr("Ctrl+Up"));
  down_ = new QPushButton(tr("Move &down"), this);
  down_->setObjectName("overlapDown");
  down_->setToolTip(tr("Ctrl+Down"));
  for (QPushButton* button : {up_, down_}) button->setAutoDefault(false);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
  buttons->button(QDialogButtonBox::Ok)->setText(tr("&Use this order"));

  auto* side = new QVBoxLayout;
  side->addWidget(up_);
  side->addWidget(down_);
  side->addStretch(1);
  auto* row = new QHBoxLayout;
  row->addWidget(list_, 1);
  row->addLayout(side);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(words);
  layout->addLayout(row, 1);
  layout->addWidget(buttons);

  connect(up_, &QPushButton::clicked, this, [this] { move(-1); });
  connect(down_, &QPushButton::clicked, this, [this] { move(1); });
  connect(list_, &QListWidget::currentRowChanged, this, &OverlapDialog::showState);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  connect(new QShortcut(Qt::CTRL | Qt::Key_Up, this), &QShortcut::activated, this,
          [this] { move(-1); });
  connect(new QShortcut(Qt::CTRL | Qt::Key_Down, this), &QShortcut::activated, this,
          [this] { move(1); });
  list_->setFocus();
  showState();
}

std::vector<std::string> OverlapDialog::order() const {
  std::vector<std::string> names;
  for (int row = 0; row < list_->count(); ++row) {
    names.push_back(list_->item(row)->text().toStdString());
  }
  return names;
}

void OverlapDialog::move(int by) {
  const int from = list_->currentRow(), to = from + by;
  if (from < 0 || to < 0 || to >= list_->count()) return;
  list_->insertItem(to, list_->takeItem(from));
  list_->setCurrentRow(to);
}

void OverlapDialog::showState() {
  up_->setEnabled(list_->currentRow() > 0);
  down_->setEnabled(list_->currentRow() >= 0 && list_->currentRow() + 1 < list_->count());
}

}  // namespace trephine
