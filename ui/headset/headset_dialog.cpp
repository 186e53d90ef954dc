#include "ui/headset/headset_dialog.h"

#include <QDialogButtonBox>
#include <QFormLayout>
#include <QGroupBox>
#include <QGuiApplication>
#include <QHBoxLayout>
#include <QPushButton>
#include <QScreen>
#include <QVBoxLayout>

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
  ahead_->setFocus(Qt::TabFocusReason);  // with its number selected
}

DecimalField* HeadsetDialog::number(const char* name, const QString& unit, double least,
                                    double most, double step, int decimals) {
  auto* field = new DecimalField(name, this);
  field->setSuffix(unit);
  field->setDecimals(decimals);
  field->setSingleStep(step);
  field->setLimits(least, most);
  return field;
}

QWidget* HeadsetDialog::buildHeadset() {
  using namespace settings;
  auto* box = new QGroupBox(tr("Headset"));
  auto* form = new QFormLayout(box);
  ahead_ = number("headsetAhead", tr(" cm"), 100.0 * kAheadLeast_m, 100.0 * kAheadMost_m, 5.0, 0);
  ahead_->show(100.0 * readWithin(kHeadsetAhead_m, kAheadLeast_m, kAheadMost_m));
  below_ = number("headsetBelow", tr(" cm"), 0.0, 100.0 * kBelowMost_m, 5.0, 0);
  below_->show(100.0 * readWithin(kHeadsetBelow_m, 0.0, kBelowMost_m));
  scale_ = number("headsetScale", tr(" %"), 100.0 * kLeastScale, 100.0 * kMostScale, 25.0, 0);
  scale_->show(100.0 * readWithin(kHeadsetScale, kLeastScale, kMostScale));
  mirror_ = new QCheckBox(tr("The &window shows what the left eye sees"));
  mirror_->setObjectName("headsetMirror");
  mirror_->setChecked(read(kHeadsetMirror));
  addRow(*form, tr("The patient is so far &ahead of the eyes"), ahead_);
  addRow(*form, tr("and so far &below them"), below_);
  addRow(*form, tr("Of the size in &life"), scale_);
  form->addRow(mirror_);
  auto* arms = new QLabel(
      tr("Where arms are registered in the room (Devices), the patient lies where they are, and "
         "each tool is seen where it is felt."));
  arms->setWordWrap(true);
  arms->setProperty("quiet", true);
  form->addRow(arms);
  ahead_->entered = [this] {
    ahead_->take();
    write(kHeadsetAhead_m, 0.01 * ahead_->wanted());
    emit headsetChanged();
  };
  below_->entered = [this] {
    below_->take();
    write(kHeadsetBelow_m, 0.01 * below_->wanted());
    emit headsetChanged();
  };
  scale_->entered = [this] {
    scale_->take();
    write(kHeadsetScale, 0.01 * scale_->wanted());
    emit headsetChanged();
  };
  connect(mirror_, &QCheckBox::toggled, this, [this](bool on) {
    write(kHeadsetMirror, on);
    emit headsetChanged();
  });
  return box;
}

QWidget* HeadsetDialog::buildScreen() {
  using namespace settings;
  auto* box = new QGroupBox(tr("Two pictures on a screen"));
  auto* form = new QFormLayout(box);
  screen_ = new QComboBox;
  screen_->setObjectName("stereoScreen");
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
  packing_ = new QComboBox;
  packing_->setObjectName("stereoPacking");
  packing_->addItem(tr("Side by side, each at half its width"), "half");
  packing_->addItem(tr("Side by side, each as it is"), "full");
  packing_->addItem(tr("Above each other, each at half its height"), "top_bottom");
  packing_->setCurrentIndex(std::max(0, packing_->findData(read(kStereoPacking))));
  eyes_ = number("stereoEyes", tr(" mm"), kEyesLeast_mm, kEyesMost_mm, 1.0, 1);
  eyes_->show(readWithin(kStereoEyes_mm, kEyesLeast_mm, kEyesMost_mm));
  away_ = number("stereoAway", tr(" cm"), 0.1 * kScreenLeast_mm, 0.1 * kScreenMost_mm, 10.0, 0);
  away_->show(0.1 * readWithin(kStereoScreen_mm, kScreenLeast_mm, kScreenMost_mm));
  lens_ = new QLineEdit(read(kStereoLens));
  lens_->setObjectName("stereoLens");
  lens_->setReadOnly(true);
  lens_->setPlaceholderText(tr("No lens"));
  auto* choose = new QPushButton(tr("Ch&oose\u2026"));
  choose->setObjectName("chooseLens");
  auto* none = new QPushButton(tr("&None"));
  none->setObjectName("noLens");
  auto* lens_row = new QHBoxLayout;
  lens_row->addWidget(lens_, 1);
  for (QPushButton* each : {choose, none}) {
    each->setAutoDefault(false);
    lens_row->addWidget(each);
  }
  form->addRow(tr("&Screen"), screen_);
  form->addRow(tr("&Pictures"), packing_);
  addRow(*form, tr("The &eyes are apart by"), eyes_);
  addRow(*form, tr("The screen is &distant by"), away_);
  form->addRow(tr("Lens before each eye"), lens_row);
  connect(screen_, &QComboBox::activated, this, [this] {
    write(kStereoScreen, screen_->currentData().toString());
    emit screenChanged();
  });
  connect(packing_, &QComboBox::activated, this, [this] {
    write(kStereoPacking, packing_->currentData().toString());
    emit screenChanged();
  });
  eyes_->entered = [this] {
    eyes_->take();
    write(kStereoEyes_mm, eyes_->wanted());
    emit screenChanged();
  };
  away_->entered = [this] {
    away_->take();
    write(kStereoScreen_mm, 10.0 * away_->wanted());
    emit screenChanged();
  };
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
