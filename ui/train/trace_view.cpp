#include "ui/train/trace_view.h"

#include <QPainter>
#include <QPolygonF>
#include <algorithm>

#include "ui/common/colours.h"

namespace trephine {

TraceView::TraceView(const QString& title, const QString& unit, double low, double high,
                     QWidget* parent)
    : QWidget(parent),
      title_(title),
      unit_(unit),
      low_(low),
      high_(high),
      colour_(colours::kAccent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  setAccessibleName(title);
}

QSize TraceView::minimumSizeHint() const {
  return {120, sizeHint().height()};
}

void TraceView::add(double time_s, double value, double demanded) {
  if (!samples_.empty() && time_s < samples_.back().time_s) samples_.clear();
  two_ = two_ || demanded != value;
  samples_.push_back({time_s, value, demanded});
  // In blocks: moving all of them with every sample would cost more than drawing.
  constexpr std::size_t kBlock = 256;
  const auto old = std::ranges::find_if(
      samples_, [&](const Sample& s) { return s.time_s >= time_s - kShown_s; });
  const auto count = std::size_t(old - samples_.begin());
  if (count >= kBlock) samples_.erase(samples_.begin(), old);
}

void TraceView::clear() {
  samples_.clear();
  two_ = false;
  update();
}

void TraceView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const int line = fontMetrics().height();
  const QRectF frame = QRectF(rect()).adjusted(0.5, line + 2.5, -0.5, -0.5);
  painter.setPen(QPen(colours::kLine, 1.0));
  painter.setBrush(colours::kPanel);
  painter.drawRect(frame);
  double low = low_, high = high_;
  for (const Sample& s : samples_) {
    low = std::min({low, s.value, s.demanded});
    high = std::max({high, s.value, s.demanded});
  }
  const double span = std::max(high - low, 1e-9);
  const double now = samples_.empty() ? 0.0 : samples_.back().time_s;
  const auto at = [&](double time_s, double value) {
    return QPointF(frame.right() - (now - time_s) / kShown_s * frame.width(),
                   frame.bottom() - 1.0 - (value - low) / span * (frame.height() - 2.0));
  };
  if (low < 0.0) {
    painter.setPen(QPen(colours::kLine, 1.0, Qt::DashLine));
    painter.drawLine(QPointF(frame.left(), at(now, 0.0).y()),
                     QPointF(frame.right(), at(now, 0.0).y()));
  }
  painter.setClipRect(frame);
  const auto draw = [&](double Sample::*value, const QColor& colour, double width) {
    QPolygonF points;
    for (const Sample& s : samples_) points << at(s.time_s, s.*value);
    painter.setPen(QPen(colour, width));
    painter.drawPolyline(points);
  };
  if (two_) draw(&Sample::demanded, colours::kQuiet, 1.0);
  draw(&Sample::value, colour_, 1.8);
  painter.setClipping(false);
  painter.setPen(colours::kQuiet);
  const QRectF words(0, 0, width(), line);
  const QString range = tr("%1 to %2 %3").arg(low, 0, 'g', 3).arg(high, 0, 'g', 3).arg(unit_);
  const int left = width() - fontMetrics().horizontalAdvance(range + QStringLiteral("  "));
  painter.drawText(words, Qt::AlignLeft | Qt::AlignVCenter,
                   fontMetrics().elidedText(title_, Qt::ElideRight, left));
  painter.drawText(words, Qt::AlignRight | Qt::AlignVCenter, range);
}

}  // namespace trephine
