#include "ui/frame/settings_dialog.h"

#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QPushButton>
#include <QVBoxLayout>

#include "ui/common/making.h"
#include "ui/common/settings.h"

namespace trephine {

SettingsDialog::SettingsDialog(const QString& storage, bool storage_locked, QWidget* parent)
    : QDialog(parent) {
  setObjectName("settingsDialog");
  setAttribute(Qt::WA_DeleteOnClose);
  setWindowTitle(tr("Settings"));
  storage_ = named(new QLineEdit(storage), "storageFolder");
  storage_->setEnabled(!storage_locked);
  auto* browse = named(new QPushButton(tr("&Choose\u2026")), "chooseStorage");
  browse->setEnabled(!storage_locked);
  browse->setAutoDefault(false);
  auto* storage_row = new QHBoxLayout;
  storage_row->addWidget(storage_, 1);
  storage_row->addWidget(browse);
  later_ = wrapped(looking(
      new QLabel(
          tr("Arms: from the next start of an exercise on. Folder, language, theme and text: when "
             "Trephine starts again.")),
      {"quiet"}));

  auto* form = new QFormLayout;
  // A field that is more than one widget is not found by its label.
  auto* storage_label = new QLabel(tr("&Storage folder"), this);
  storage_label->setBuddy(storage_);
  form->addRow(storage_label, storage_row);
  rows_ = std::make_unique<FieldRows<Preferences>>(FieldsOf<Preferences>(kWorkFields), *form, this,
                                                   QString());
  (*rows_)["language"].describe([](const std::string& language) {
    return FieldEditor::ChoiceText{
        language == "en" ? tr("English") : QStringLiteral("\u7e41\u9ad4\u4e2d\u6587"), {}, {}};
  });
  (*rows_)["hands/main"].describe([](const std::string& hand) {
    return FieldEditor::ChoiceText{hand == "right" ? tr("Right hand") : tr("Left hand"), {}, {}};
  });
  rows_->entered = [this](const Preferences& wanted, const char*) {
    wanted_ = wanted;
    rows_->show(wanted_);
  };
  rows_->show(wanted_);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Save | QDialogButtonBox::Cancel);
  connect(buttons, &QDialogButtonBox::accepted, this, &SettingsDialog::save);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  connect(browse, &QPushButton::clicked, this, &SettingsDialog::chooseFolder);
  auto* layout = new QVBoxLayout(this);
  layout->addLayout(form);
  layout->addWidget(later_);
  layout->addWidget(buttons);
}

void SettingsDialog::chooseFolder() {
  auto* dialog =
      named(new QFileDialog(this, tr("Where cases and exercises are kept")), "storageDialog");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(QFileDialog::Directory);
  dialog->setOption(QFileDialog::ShowDirsOnly);
  connect(dialog, &QFileDialog::fileSelected, storage_, &QLineEdit::setText);
  dialog->open();
}

void SettingsDialog::save() {
  if (rows_->anyRefused()) return;  // it says why
  if (storage_->isEnabled() && storage_->isModified()) {
    write(settings::kStorage, storage_->text().trimmed());
  }
  keepPreferences(wanted_);
  emit changed();
  accept();
}

}  // namespace trephine
