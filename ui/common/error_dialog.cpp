#include "ui/common/error_dialog.h"

#include <QCoreApplication>

#include "base/utf8.h"
#include "ui/common/words.h"

namespace trephine {

QMessageBox* showError(QWidget* parent, const Error& error) {
  auto* dialog = new QMessageBox(parent);
  dialog->setObjectName("errorDialog");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setIcon(QMessageBox::Warning);
  dialog->setWindowTitle(QCoreApplication::translate("ErrorDialog", "Trephine"));
  dialog->setTextFormat(Qt::PlainText);
  const auto line = [](const std::string& text) { return toQt(cleanUtf8(text)); };
  dialog->setText(line(error.what) + '.');
  QStringList more;
  if (!error.where.empty()) {
    more << QCoreApplication::translate("ErrorDialog", "Where: %1").arg(line(error.where));
  }
  if (!error.next.empty()) {
    more << QCoreApplication::translate("ErrorDialog", "What to do: %1.").arg(line(error.next));
  }
  dialog->setInformativeText(more.join("\n\n"));
  dialog->setStandardButtons(QMessageBox::Ok);
  dialog->open();
  return dialog;
}

}  // namespace trephine
