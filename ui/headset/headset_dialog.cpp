#include "ui/headset/headset_dialog.h"

#include <QDialogButtonBox>
#include <QFormLayout>
#include <QGroupBox>
#include <QGuiApplication>
#include <QHBoxLayout>
#include <QPushButton>
#include <QScreen>
#include <QVBoxLayout>

#include "ui/common/making.h"
#include "ui/common/settings.h"

namespace trephine {

HeadsetDialog::HeadsetDialog(QWidget* parent) : QDialog(parent) {
  setObjectName("headsetDialog");
  setAttribute(Qt::WA_DeleteOnClose);
  setWindowTitle(tr("Headset and screens"));
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
  buttons->button(QDialogButtonBox::Close)->setAutoDefault(false);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(buildHeadset());
  layout->addWidget(buildScreen());
  layout->addWidget(buttons);
  layout->setSizeConstraint(QLayout::SetFixedSize);  // room for a refusal, and no more
  (*of_headset_)["headset/ahead_m"].setFocus(Qt::TabFocusReason);  // with its number selected
}

// What is entered is kept at once.
std::unique_ptr<HeadsetDialog::Rows> HeadsetDialog::rows(FieldsOf<Preferences> fields,
                                                         QFormLayout& form,
                                                         void (HeadsetDialog::*changed)()) {
  auto made = std::make_unique<Rows>(fields, form, this, QString());
  made->entered = [this, fields, changed, rows = made.get()](const Preferences& wanted,
                                                             const char*) {
    Preferences all = preferences();
    for (const FieldOf<Preferences>& field : fields) setValue(field, all, valueOf(field, wanted));
    keepPreferences(all);
    rows->show(all);
    emit(this->*changed)();
  };
  made->show(preferences());
  return made;
}

QWidget* HeadsetDialog::buildHeadset() {
  auto* box = new QGroupBox(tr("Headset"));
  auto* form = new QFormLayout(box);
  of_headset_ = rows(kHeadsetFields, *form, &HeadsetDialog::headsetChanged);
  auto* arms = wrapped(looking(
      new QLabel(tr(
          "Where arms are registered in the room (Devices), the patient lies where they are, and "
          "each tool is seen where it is felt.")),
      {"quiet"}));
  form->addRow(arms);
  return box;
}

QWidget* HeadsetDialog::buildScreen() {
  using namespace settings;
  auto* box = new QGroupBox(tr("Two pictures on a screen"));
  auto* form = new QFormLayout(box);
  screen_ = named(new QComboBox, "stereoScreen");
  screen_->addItem(tr("Another than the window's"), QString());
  const QString chosen = read(kStereoScreen);
  for (const QScreen* each : QGuiApplication::screens()) {
    const bool own = parentWidget() && each == parentWidget()->screen();
    screen_->addItem((own ? tr("%1, %2 \u00d7 %3, over the window") : tr("%1, %2 \u00d7 %3"))
                         .arg(each->name())
                         .arg(each->geometry().width())
                         .arg(each->geometry().height()),
                     each->name());
  }
  if (screen_->findData(chosen) < 0) screen_->addItem(tr("%1, not connected").arg(chosen), chosen);
  screen_->setCurrentIndex(screen_->findData(chosen));
  lens_ = named(new QLineEdit(read(kStereoLens)), "stereoLens");
  lens_->setReadOnly(true);
  lens_->setPlaceholderText(tr("No lens"));
  auto* choose = named(new QPushButton(tr("Ch&oose\u2026")), "chooseLens");
  auto* none = named(new QPushButton(tr("&None")), "noLens");
  auto* lens_row = new QHBoxLayout;
  lens_row->addWidget(lens_, 1);
  for (QPushButton* each : {choose, none}) {
    each->setAutoDefault(false);
    lens_row->addWidget(each);
  }
  form->addRow(tr("&Screen"), screen_);
  of_screen_ = rows(kScreenFields, *form, &HeadsetDialog::screenChanged);
  (*of_screen_)["stereo/packing"].describe([](const std::string& packing) {
    return FieldEditor::ChoiceText{packing == "half" ? tr("Side by side, each at half its width")
                                   : packing == "full"
                                       ? tr("Side by side, each as it is")
                                       : tr("Above each other, each at half its height"),
                                   {},
                                   {}};
  });
  form->addRow(tr("Lens before each eye"), lens_row);
  connect(screen_, &QComboBox::activated, this, [this] {
    write(kStereoScreen, screen_->currentData().toString());
    emit screenChanged();
  });
  connect(choose, &QPushButton::clicked, this, &HeadsetDialog::lensWanted);
  connect(none, &QPushButton::clicked, this, [this] { setLens({}); });
  return box;
}

void HeadsetDialog::setLens(const QString& file) {
  lens_->setText(file);
  write(settings::kStereoLens, file);
  emit screenChanged();
}

}  // namespace trephine
