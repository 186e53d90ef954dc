#include "ui/cases/state_mark.h"

#include <numbers>

#include "ui/common/colours.h"

namespace trephine {

namespace {

// All marks are drawn in a 24 x 24 box.
void paintTick(QPainter& p) {
  p.drawPolyline(QPolygonF({{7, 12.5}, {10.7, 16.2}, {17.2, 8.4}}));
}

QPolygonF octagon() {
  QPolygonF corners;
  for (int i = 0; i < 8; ++i) {
    const double angle = (i + 0.5) * std::numbers::pi / 4.0;
    corners << QPointF(12.0 + 11.0 * std::cos(angle), 12.0 + 11.0 * std::sin(angle));
  }
  return corners;
}

}  // namespace

void paintStateMark(QPainter& painter, const QRectF& box, SeriesState state) {
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  painter.translate(box.topLeft());
  painter.scale(box.width() / 24.0, box.height() / 24.0);
  const QColor colour = stateColour(state);
  const QPen sign(colours::kPanel, 2.4, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin);
  painter.setPen(Qt::NoPen);
  painter.setBrush(colour);
  switch (state) {
    case SeriesState::pass:
      painter.drawEllipse(QRectF(1.5, 1.5, 21, 21));
      painter.setPen(sign);
      paintTick(painter);
      break;
    case SeriesState::repaired:
      painter.setPen(QPen(colour, 2.0, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
      painter.drawPolygon(QPolygonF({{12, 2.5}, {22.5, 20.5}, {1.5, 20.5}}));
      painter.setPen(sign);
      painter.drawLine(QPointF(12, 9), QPointF(12, 13.5));
      painter.drawPoint(QPointF(12, 17.3));
      break;
    case SeriesState::answered:
      painter.drawRoundedRect(QRectF(2, 2, 20, 20), 3, 3);
      painter.setPen(sign);
      paintTick(painter);
      break;
    case SeriesState::asks: {
      painter.setBrush(Qt::NoBrush);
      painter.setPen(QPen(colour, 2.0));
      painter.drawEllipse(QRectF(2.5, 2.5, 19, 19));
      painter.setPen(QPen(colour, 2.2, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
      painter.drawArc(QRectF(8.7, 6.2, 6.6, 6.6), -90 * 16, 250 * 16);
      painter.drawLine(QPointF(12, 12.8), QPointF(12, 14.2));
      painter.drawPoint(QPointF(12, 17.6));
      break;
    }
    case SeriesState::structures:  // a shape over another
      painter.setBrush(Qt::NoBrush);
      painter.setPen(QPen(colour, 2.0));
      painter.drawRect(QRectF(2.5, 2.5, 13, 13));
      painter.setBrush(colours::kPanel);
      painter.drawEllipse(QRectF(9, 9, 12.5, 12.5));
      break;
    case SeriesState::refused:
      painter.drawPolygon(octagon());
      painter.setPen(sign);
      painter.drawLine(QPointF(8, 8), QPointF(16, 16));
      painter.drawLine(QPointF(16, 8), QPointF(8, 16));
      break;
  }
  painter.restore();
}

QIcon stateIcon(SeriesState state) {
  QIcon icon;
  for (int pixels : {24, 48, 72}) {
    QPixmap pixmap(pixels, pixels);
    pixmap.fill(Qt::transparent);
    QPainter painter(&pixmap);
    paintStateMark(painter, QRectF(0, 0, pixels, pixels), state);
    painter.end();
    icon.addPixmap(pixmap);
    icon.addPixmap(pixmap, QIcon::Disabled);
  }
  return icon;
}

}  // namespace trephine
