#include "ui/views/slice_preview.h"

#include <QCoreApplication>
#include <QHBoxLayout>
#include <QShortcut>
#include <QVBoxLayout>
#include <QWheelEvent>
#include <utility>

#include "ui/common/making.h"
#include "ui/common/placing.h"
#include "ui/common/words.h"
#include "ui/views/steps.h"

namespace trephine {

namespace {
constexpr int kNoAirHu = -900;  // what removeCouch counts as gone
}  // namespace

SlicePreview::SlicePreview(QWidget* parent) : QWidget(parent) {
  canvas_ = named(new SliceCanvas(this), "sliceCanvas");

  windows_ = new QButtonGroup(this);
  auto* window_row = new QHBoxLayout;
  window_row->setSpacing(4);
  for (int i = 0; i < int(kWindowPresets.size()); ++i) {
    const WindowPreset& preset = kWindowPresets[std::size_t(i)];
    auto* button = named(new QToolButton(this), QString("window%1").arg(i + 1), {"segment"});
    button->setText(QCoreApplication::translate("HuWindow", preset.name));
    button->setToolTip(tr("Width %1 HU around %2 HU (key %3). Only the picture changes.")
                           .arg(preset.window.width_hu)
                           .arg(preset.window.centre_hu)
                           .arg(i + 1));
    button->setCheckable(true);
    button->setFocusPolicy(Qt::StrongFocus);
    connect(new QShortcut(QKeySequence(Qt::Key_1 + i), this), &QShortcut::activated, button,
            &QAbstractButton::click);
    windows_->addButton(button, i);
    window_row->addWidget(button);
  }
  window_ = named(new ElidedLabel(this), "windowNumbers", {"quiet"});
  box_ = named(new QToolButton(this), "cropTool", {"segment"});
  box_->setText(tr("Crop"));
  box_->setToolTip(
      tr("While this is pressed, a drag over the slice chooses the part that is imported"));
  box_->setCheckable(true);
  window_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);  // where there is room
  window_row->addWidget(window_, 1);
  windows_->button(int(kFirstPreset))->setChecked(true);
  connect(box_, &QAbstractButton::toggled, this, [this] { setCroppable(croppable_); });
  connect(canvas_, &SliceCanvas::windowDragged, this, &SlicePreview::showWindow);

  slider_ = named(new QSlider(Qt::Horizontal, this), "sliceSlider");
  slider_->setAccessibleName(tr("Slice"));
  slider_->setMinimumWidth(40);
  slider_->setPageStep(kPageOfSlices);
  position_ = named(new QLabel(this), "slicePosition");
  position_->setMinimumWidth(
      fontMetrics().horizontalAdvance(tr("Slice %1 of %2").arg("0000", "0000")));
  position_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  auto* slider_row = new QHBoxLayout;
  slider_row->addWidget(slider_, 1);
  slider_row->addWidget(position_);
  slider_row->addWidget(box_);

  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(8, 0, 8, 0);
  layout->addLayout(window_row);
  layout->addWidget(canvas_, 1);
  layout->addLayout(slider_row);

  connect(windows_, &QButtonGroup::idClicked, this, [this](int i) {
    canvas_->setWindow(kWindowPresets[std::size_t(i)].window);
    showWindow();
  });
  connect(slider_, &QSlider::valueChanged, this, [this](int index) {
    showPosition();
    emit sliceWanted(index);
  });
  const auto pages = [this](Qt::Key key, QAbstractSlider::SliderAction action) {
    connect(new QShortcut(QKeySequence(key), this), &QShortcut::activated, this,
            [this, action] { slider_->triggerAction(action); });
  };
  pages(Qt::Key_PageUp, QAbstractSlider::SliderPageStepAdd);
  pages(Qt::Key_PageDown, QAbstractSlider::SliderPageStepSub);
  showNothing({});
  setCroppable(false);
  showWindow();
}

void SlicePreview::setCroppable(bool croppable) {
  croppable_ = croppable;
  box_->setVisible(croppable);
  canvas_->setDrawable(croppable && box_->isChecked());
}

// A preset is one of them alone.
void SlicePreview::showWindow() {
  const HuWindow& now = canvas_->window();
  window_->setText(tr("W %1 L %2").arg(now.width_hu).arg(now.centre_hu));
  windows_->setExclusive(false);
  for (int i = 0; i < int(kWindowPresets.size()); ++i) {
    windows_->button(i)->setChecked(kWindowPresets[std::size_t(i)].window == now);
  }
  windows_->setExclusive(true);
}

void SlicePreview::showStack(int count, const std::optional<Mat3>& direction) {
  if (count <= 0) return showNothing(tr("There is nothing to show."));
  canvas_->setDirection(direction);
  canvas_->fit();
  {
    const QSignalBlocker quiet(slider_);
    slider_->setRange(0, count - 1);
    slider_->setValue(count / 2);
  }
  slider_->setEnabled(count > 1);
  showPosition();
  emit sliceWanted(slider_->value());
}

void SlicePreview::setBodyPart(const std::string& body_part) {
  if (std::exchange(body_part_, body_part) == body_part) return;
  canvas_->setWindow(windowOfBodyPart(body_part));
  showWindow();
}

void SlicePreview::showNothing(const QString& why) {
  {
    const QSignalBlocker quiet(slider_);
    slider_->setRange(0, 0);
  }
  slider_->setEnabled(false);
  position_->clear();
  canvas_->setMessage(why);
}

void SlicePreview::showSlice(int index, const Result<SlicePicture>& picture) {
  if (index < slider_->minimum() || index > slider_->maximum()) return;
  if (picture) {
    canvas_->setSlice(*picture);
  } else if (index == slider_->value()) {
    canvas_->setMessage(tr("This slice cannot be shown: %1.").arg(toQt(picture.error().what)));
  }
}

void SlicePreview::showPosition() {
  position_->setText(tr("Slice %1 of %2").arg(slider_->value() + 1).arg(slider_->maximum() + 1));
}

SlicePicture sliceOf(const Volume& volume, int k) {
  const GridGeometry& g = volume.geometry;
  if (!g.contains(0, 0, k)) return {};
  const auto begin = volume.hu.begin() + std::ptrdiff_t(g.indexOf(0, 0, k));
  return {
      g.size[0], g.size[1], g.spacing_mm, {begin, begin + std::ptrdiff_t(g.size[0]) * g.size[1]}};
}

QImage couchMask(const CouchFinding& couch, const Volume& volume, int k) {
  const GridGeometry& g = volume.geometry;
  if (!couch.found || !g.contains(0, 0, k)) return {};
  QImage mask(g.size[0], g.size[1], QImage::Format_Alpha8);
  for (int j = 0; j < g.size[1]; ++j) {
    uchar* line = mask.scanLine(j);
    for (int i = 0; i < g.size[0]; ++i) {
      line[i] = volume.at(i, j, k) > kNoAirHu && couch.isCouch(i, j, k) ? 255 : 0;
    }
  }
  return mask;
}

void SlicePreview::wheelEvent(QWheelEvent* event) {
  turned_ += event->angleDelta().y();
  const int notches = turned_ / QWheelEvent::DefaultDeltasPerStep;
  turned_ -= notches * QWheelEvent::DefaultDeltasPerStep;  // a touchpad sends parts of a notch
  slider_->setValue(slider_->value() - notches);
  event->accept();
}

void SlicePreview::mousePressEvent(QMouseEvent*) {
  slider_->setFocus();
}

}  // namespace trephine
