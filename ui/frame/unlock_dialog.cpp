#include "ui/frame/unlock_dialog.h"

#include <QDialogButtonBox>
#include <QVBoxLayout>

#include "ui/common/colours.h"
#include "ui/common/making.h"

namespace trephine {

UnlockDialog::UnlockDialog(const Pin& pin, QWidget* parent) : QDialog(parent), pin_(pin) {
  setObjectName("unlockDialog");
  setAttribute(Qt::WA_DeleteOnClose);
  setWindowTitle(tr("Unlock for teaching"));
  text_ = named(new QLineEdit, "pin");
  text_->setEchoMode(QLineEdit::Password);
  text_->setMaxLength(int(kMostOfPin));
  text_->setAccessibleName(tr("PIN"));
  said_ = wrapped(named(
      new QLabel(tr("An educator's PIN unlocks controller, tissues and rate until you lock them "
                    "again, or Trephine is closed.")),
      "pinSaid"));
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Cancel);
  unlock_ = buttons->addButton(tr("&Unlock"), QDialogButtonBox::AcceptRole);
  unlock_->setObjectName("unlock");
  connect(buttons, &QDialogButtonBox::accepted, this, &UnlockDialog::check);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* layout = new QVBoxLayout(this);
  addAll(*layout, {said_, text_, buttons});
  text_->setFocus();
}

void UnlockDialog::check() {
  const bool begun =
      checking_.run([pin = pin_, text = text_->text().toStdString()](
                        const Progress&) -> Result<bool> { return pinMatches(pin, text); },
                    [this](Result<bool> matches) {
                      unlock_->setEnabled(true);
                      text_->clear();
                      if (matches && *matches) {
                        emit unlocked();
                        return accept();
                      }
                      said_->setText(tr("That is not the PIN. Nothing is unlocked."));
                      colours::setText(*said_, colours::kBad);
                      text_->setFocus();
                    });
  if (begun) unlock_->setEnabled(false);
}

}  // namespace trephine
