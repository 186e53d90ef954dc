#include "ui/common/floating_card.h"

#include <QEvent>
#include <QLayout>
#include <QPushButton>
#include <algorithm>

namespace trephine {

FloatingCard::FloatingCard(QWidget& over, At at, int widest)
    : QFrame(&over), at_(at), widest_(widest) {
  setProperty("overlay", true);
  over.installEventFilter(this);
  hide();
}

void FloatingCard::place() {
  if (!layout()) return;
  const QWidget* over = parentWidget();
  const int width = std::min(widest_, over->width() - 2 * kMargin);
  fit(width, over->height() - 2 * kMargin);
  layout()->activate();
  const int wanted = layout()->hasHeightForWidth() ? layout()->totalHeightForWidth(width)
                                                   : layout()->totalSizeHint().height();
  const int height = std::min(wanted, over->height() - 2 * kMargin);
  const bool to_corners = (over->width() - width) / 2 < kCorner;
  const int bottom = to_corners ? kAboveCorners : kMargin;
  const int y = at_ == At::top      ? kMargin
                : at_ == At::bottom ? over->height() - height - bottom
                                    : (over->height() - height) / 2;
  setGeometry((over->width() - width) / 2, y, width, height);
  raise();
}

void FloatingCard::takeTabFrom(QWidget& before) {
  QWidget* last = &before;
  for (QPushButton* button : findChildren<QPushButton*>()) {
    setTabOrder(last, button);
    last = button;
  }
}

bool FloatingCard::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize && watched == parentWidget()) place();
  return QFrame::eventFilter(watched, event);
}

void FloatingCard::showEvent(QShowEvent* event) {
  QFrame::showEvent(event);
  place();
}

}  // namespace trephine
