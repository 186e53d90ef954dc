#include "ui/frame/settings_dialog.h"

#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QPushButton>
#include <QVBoxLayout>

#include "ui/common/settings.h"

namespace trephine {

namespace {

constexpr int kLeastText = 80, kMostText = 200;

QComboBox* choices(const char* name, const QList<QPair<QString, QString>>& items,
                   const QString& in_use) {
  auto* box = new QComboBox;
  box->setObjectName(name);
  for (const auto& [value, words] : items) box->addItem(words, value);
  box->setCurrentIndex(std::max(0, box->findData(in_use)));
  return box;
}

}  // namespace

SettingsDialog::SettingsDialog(const QString& storage, bool storage_locked, QWidget* parent)
    : QDialog(parent) {
  setObjectName("settingsDialog");
  setAttribute(Qt::WA_DeleteOnClose);
  setWindowTitle(tr("Settings"));
  storage_ = new QLineEdit(storage);
  storage_->setObjectName("storageFolder");
  storage_->setEnabled(!storage_locked);
  auto* browse = new QPushButton(tr("&Choose\u2026"));
  browse->setObjectName("chooseStorage");
  browse->setEnabled(!storage_locked);
  browse->setAutoDefault(false);
  auto* storage_row = new QHBoxLayout;
  storage_row->addWidget(storage_, 1);
  storage_row->addWidget(browse);
  language_ = choices(
      "language", {{"en", tr("English")}, {"zh_TW", QStringLiteral("\u7e41\u9ad4\u4e2d\u6587")}},
      read(settings::kLanguage));
  theme_ = choices("theme", {{"dark", tr("Dark")}, {"light", tr("Light")}}, read(settings::kTheme));
  text_ = new WholeNumberField("textPercent");
  text_->setSuffix(tr(" %"));
  text_->setSingleStep(10);
  text_->setLimits(kLeastText, kMostText);
  text_->show(readWithin(settings::kTextScale, kLeastText, kMostText));
  hand_ = choices("mainHand", {{"right", tr("Right hand")}, {"left", tr("Left hand")}},
                  read(settings::kMainHand));
  push_ = new DecimalField("pushStep");
  push_->setSuffix(tr(" N"));
  push_->setDecimals(2);
  push_->setSingleStep(0.05);
  push_->setLimits(0.05, 1.0);
  push_->show(readWithin(settings::kPushStep_N, 0.05, 1.0));
  step_ = new DecimalField("keyStep");
  step_->setSuffix(tr(" mm"));
  step_->setDecimals(1);
  step_->setSingleStep(0.5);
  step_->setLimits(0.1, 5.0);
  step_->show(readWithin(settings::kKeyStep_mm, 0.1, 5.0));
  arm_limit_ = new DecimalField("armLimit");
  arm_limit_->setSuffix(tr(" N"));
  arm_limit_->setDecimals(1);
  arm_limit_->setSingleStep(0.5);
  arm_limit_->setLimits(settings::kArmsLeast_N, settings::kArmsMost_N);
  arm_limit_->show(
      readWithin(settings::kArmsLimit_N, settings::kArmsLeast_N, settings::kArmsMost_N));
  later_ = new QLabel(
      tr("Arms: from the next start of an exercise on. Folder, language, theme and text: when "
         "Trephine starts again."));
  later_->setProperty("quiet", true);
  later_->setWordWrap(true);

  auto* form = new QFormLayout;
  // A field that is more than one widget is not found by its label.
  auto* storage_label = new QLabel(tr("&Storage folder"), this);
  storage_label->setBuddy(storage_);
  form->addRow(storage_label, storage_row);
  form->addRow(tr("&Language"), language_);
  form->addRow(tr("&Theme"), theme_);
  addRow(*form, tr("Size of te&xt"), text_);
  addRow(*form, tr("An arm &gives at most"), arm_limit_);
  form->addRow(tr("The mouse &begins with the"), hand_);
  addRow(*form, tr("One notch of the &wheel pushes by"), push_);
  addRow(*form, tr("An &arrow key moves by"), step_);
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
  auto* dialog = new QFileDialog(this, tr("Where cases and exercises are kept"));
  dialog->setObjectName("storageDialog");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(QFileDialog::Directory);
  dialog->setOption(QFileDialog::ShowDirsOnly);
  connect(dialog, &QFileDialog::fileSelected, storage_, &QLineEdit::setText);
  dialog->open();
}

void SettingsDialog::save() {
  for (bool refused :
       {text_->isRefused(), push_->isRefused(), step_->isRefused(), arm_limit_->isRefused()}) {
    if (refused) return;  // it says why
  }
  if (storage_->isEnabled() && storage_->isModified()) {
    write(settings::kStorage, storage_->text().trimmed());
  }
  write(settings::kLanguage, language_->currentData().toString());
  write(settings::kTheme, theme_->currentData().toString());
  write(settings::kTextScale, text_->wanted());
  write(settings::kArmsLimit_N, arm_limit_->wanted());
  write(settings::kMainHand, hand_->currentData().toString());
  write(settings::kPushStep_N, push_->wanted());
  write(settings::kKeyStep_mm, step_->wanted());
  emit changed();
  accept();
}

}  // namespace trephine
