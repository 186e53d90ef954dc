#include "ui/work/messages.h"

#include <QApplication>
#include <QFileInfo>
#include <QRegularExpression>

#include "base/log.h"
#include "session/session.h"
#include "ui/common/error_dialog.h"
#include "ui/common/words.h"

namespace trephine {

void Messages::report(const Error& error) {
  spdlog::warn("Said in the window: {}", error.code.str());  // no more: the rest may name files
  showError(asking(), error);
  emit failed(error);
}

// Over a dialog that is open, so that the keys come back to it.
QWidget* Messages::asking() const {
  QWidget* dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
  // One that a file was just chosen in is about to go.
  while (qobject_cast<QFileDialog*>(dialog)) dialog = dialog->parentWidget();
  for (const QObject* of = dialog; of; of = of->parent()) {
    if (of == &window_) return dialog;
  }
  return &window_;
}

QFileDialog* Messages::fileDialog(const char* name, const QString& title, const QString& filter) {
  auto* dialog = new QFileDialog(asking(), title, {}, filter);
  dialog->setObjectName(name);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(QFileDialog::ExistingFile);
  // Where files of this kind were last: Qt's own memory is one place for all kinds.
  QString& last = folders_[name + filter];
  dialog->setDirectory(last.isEmpty() ? QDir::homePath() : last);
  connect(dialog, &QFileDialog::fileSelected, this,
          [&last](const QString& file) { last = QFileInfo(file).absolutePath(); });
  return dialog;
}

void Messages::askForFile(const char* name, const QString& title, const QString& filter,
                          GotPath then) {
  QFileDialog* dialog = fileDialog(name, title, filter);
  connect(dialog, &QFileDialog::fileSelected, this,
          [then = std::move(then)](const QString& file) { then(toPath(file)); });
  dialog->open();
}

// A name that is not there yet is a folder that will be made.
void Messages::askForNewFolder(const char* name, const QString& title, const QString& suggestion,
                               GotPath then) {
  QFileDialog* dialog = fileDialog(name, title);
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  dialog->setFileMode(QFileDialog::AnyFile);
  dialog->setOption(QFileDialog::ShowDirsOnly);
  dialog->selectFile(suggestion);
  dialog->setLabelText(QFileDialog::FileName, tr("New folder:"));
  connect(dialog, &QFileDialog::fileSelected, this,
          [then = std::move(then)](const QString& folder) { then(toPath(folder)); });
  dialog->open();
}

QFileDialog* Messages::saveDialog(const QString& title, const QString& suggestion,
                                  const QString& filter) {
  QFileDialog* dialog = fileDialog("saveDialog", title, filter);
  dialog->setFileMode(QFileDialog::AnyFile);
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  const QFileInfo suggested(suggestion);
  // A name that is free there: nothing is replaced by one that nobody typed.
  const auto free =
      freshFile(toPath(dialog->directory().absolutePath()), suggested.baseName().toStdString(),
                '.' + suggested.completeSuffix().toStdString());
  dialog->selectFile(toQt(free.filename()));
  dialog->setDefaultSuffix(suggested.completeSuffix());
  // A plain name is of the kind that is chosen.
  connect(dialog, &QFileDialog::filterSelected, dialog, [dialog](const QString& chosen) {
    static const QRegularExpression first("\\*\\.([^ )]+)");
    const QString suffix = first.match(chosen).captured(1);
    if (!suffix.isEmpty()) dialog->setDefaultSuffix(suffix);
  });
  return dialog;
}

}  // namespace trephine
