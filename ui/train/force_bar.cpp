#include "ui/train/force_bar.h"

#include <QPainter>
#include <algorithm>

#include "ui/common/colours.h"

namespace trephine {

ForceBar::ForceBar(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void ForceBar::setForce(double sent_N, double demanded_N, double limit_N) {
  if (sent_N == sent_N_ && demanded_N == demanded_N_ && limit_N == limit_N_) return;
  sent_N_ = sent_N;
  demanded_N_ = demanded_N;
  limit_N_ = limit_N;
  update();
}

void ForceBar::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QRectF frame = QRectF(rect()).adjusted(0.5, 1.5, -0.5, -1.5);
  painter.setPen(QPen(colours::kLine, 1.0));
  painter.setBrush(colours::kPanel);
  painter.drawRoundedRect(frame, 3, 3);

  const QRectF inside = frame.adjusted(1.5, 1.5, -1.5, -1.5);
  const double limit = std::max(limit_N_, 1e-6);
  const double share = std::clamp(sent_N_ / limit, 0.0, 1.0);
  const QColor colour = share > 0.95  ? colours::kBad
                        : share > 0.7 ? colours::kCaution
                                      : colours::kGood;
  painter.setPen(Qt::NoPen);
  painter.setBrush(colour);
  painter.drawRect(QRectF(inside.left(), inside.top(), inside.width() * share, inside.height()));

  if (demanded_N_ <= 0.0) return;
  const bool beyond = demanded_N_ > limit;
  const double x = inside.left() + inside.width() * std::clamp(demanded_N_ / limit, 0.0, 1.0);
  painter.setPen(QPen(beyond ? colours::kBad : colours::kText, 2.0));
  const double at = std::clamp(x, inside.left() + 1, inside.right() - 1);
  painter.drawLine(QPointF(at, frame.top()), QPointF(at, frame.bottom()));
}

}  // namespace trephine
