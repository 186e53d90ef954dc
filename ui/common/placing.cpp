#include "ui/common/placing.h"

#include <QPainter>
#include <QScreen>
#include <QStyle>
#include <algorithm>

namespace trephine {

namespace {
// A window manager's borders and title; what they are is known only once the window is shown.
constexpr QSize kFrame(8, 36);
}  // namespace

QSize sizeOnScreen(const QSize& wanted, const QWidget& window) {
  return wanted.boundedTo(window.screen()->availableSize() - kFrame);
}

void centreOver(QWidget& dialog, const QWidget& window) {
  const QRect screen = window.screen()->availableGeometry();
  QRect place(QPoint(), dialog.size());
  place.moveCenter(window.geometry().center());
  dialog.move(std::max(screen.left(), std::min(place.left(), screen.right() - place.width())),
              std::max(screen.top(), std::min(place.top(), screen.bottom() - place.height())));
}

QScrollArea* scrolled(QWidget* page, const char* name) {
  auto* area = new QScrollArea;
  area->setFocusPolicy(Qt::TabFocus);  // a click beside its controls takes the keys from nobody
  area->setObjectName(name);
  area->setWidget(page);
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  return area;
}

QSize ElidedLabel::minimumSizeHint() const {
  return {0, QLabel::minimumSizeHint().height()};
}

void ElidedLabel::paintEvent(QPaintEvent*) {
  const QString shown = fontMetrics().elidedText(text(), Qt::ElideRight, contentsRect().width());
  setToolTip(!more_.isEmpty() ? more_ : shown == text() ? QString() : text());
  QPainter painter(this);
  style()->drawItemText(&painter, contentsRect(), int(alignment()), palette(), isEnabled(), shown,
                        foregroundRole());
}

}  // namespace trephine
