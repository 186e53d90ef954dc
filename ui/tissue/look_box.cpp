#include "ui/tissue/look_box.h"

#include <QPainter>
#include <QAbstractItemView>
#include <QPainterPath>
#include <QStyleOptionComboBox>
#include <QStylePainter>

#include "ui/common/colours.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

// An eye: open, its outline alone, and crossed out.
QIcon eye(TissueLook look) {
  QPixmap pixmap(48, 48);
  pixmap.setDevicePixelRatio(2.0);
  pixmap.fill(Qt::transparent);
  QPainter p(&pixmap);
  p.setRenderHint(QPainter::Antialiasing);
  QPen pen(colours::kText, 1.8, Qt::SolidLine, Qt::RoundCap);
  if (look == TissueLook::ghosted) pen.setDashPattern({1.5, 2.0});
  p.setPen(pen);
  QPainterPath lids;
  lids.moveTo(2.5, 12);
  lids.quadTo(12, 2.5, 21.5, 12);
  lids.quadTo(12, 21.5, 2.5, 12);
  p.drawPath(lids);
  if (look == TissueLook::shown) {
    p.setBrush(colours::kText);
    p.drawEllipse(QPointF(12, 12), 3.6, 3.6);
  }
  if (look == TissueLook::hidden) p.drawLine(QPointF(4, 20), QPointF(20, 4));
  return QIcon(pixmap);
}

}  // namespace

LookBox::LookBox(QWidget* parent) : QComboBox(parent) {
  // By number of TissueLook.
  addItem(eye(TissueLook::shown), tr("Shown"));
  addItem(eye(TissueLook::ghosted), tr("Ghosted"));
  addItem(eye(TissueLook::hidden), tr("Hidden"));
  setToolTip(tr("In the views only: what is felt and cut stays as it is"));
  connect(this, &QComboBox::activated, this, [this](int look) {
    if (chosen) chosen(TissueLook(look));
  });
}

void LookBox::setIconAlone() {
  icon_alone_ = true;
  view()->setMinimumWidth(QComboBox::sizeHint().width());
  updateGeometry();
}

QSize LookBox::sizeHint() const {
  constexpr int kFrameAndArrow = 28;
  QSize hint = QComboBox::sizeHint();
  if (icon_alone_) hint.setWidth(iconSize().width() + kFrameAndArrow);
  return hint;
}

QSize LookBox::minimumSizeHint() const {
  return icon_alone_ ? sizeHint() : QComboBox::minimumSizeHint();
}

void LookBox::paintEvent(QPaintEvent* event) {
  if (!icon_alone_) return QComboBox::paintEvent(event);
  QStylePainter painter(this);
  QStyleOptionComboBox option;
  initStyleOption(&option);
  option.currentText.clear();
  painter.drawComplexControl(QStyle::CC_ComboBox, option);
  painter.drawControl(QStyle::CE_ComboBoxLabel, option);
}

void LookBox::show(const Tissue& tissue, TissueLook look) {
  setObjectName(toQt("look:" + tissue.id));
  setAccessibleName(tr("Look of %1").arg(toQt(tissue.name)));
  setCurrentIndex(int(look));
}

}  // namespace trephine
