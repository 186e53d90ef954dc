#include "ui/common/error_dialog.h"

#include <QCoreApplication>

#include "ui/common/words.h"

namespace trephine {

QMessageBox* showError(QWidget* parent, const Error& error) {
  auto* dialog = new QMessageBox(parent);
  dialog->setObjectName("errorDialog");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setIcon(QMessageBox::Warning);
  dialog->setWindowTitle(QCoreApplication::translate("ErrorDialog", "Trephine"));
  dialog->setTextFormat(Qt::PlainText);
  dialog->setText(toQt(error.what) + '.');
  QStringList more;
  if (!error.where.empty()) {
    more << QCoreApplication::translate("ErrorDialog", "Where: %1").arg(toQt(error.where));
  }
  if (!error.next.empty()) {
    more << QCoreApplication::translate("ErrorDialog", "What to do: %1.").arg(toQt(error.next));
  }
  dialog->setInformativeText(more.join("\n\n"));
  dialog->setStandardButtons(QMessageBox::Ok);
  dialog->open();
  return dialog;
}

}  // namespace trephine
