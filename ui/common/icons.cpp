#include "ui/common/icons.h"

#include <QPainter>
#include <QPainterPath>

#include "ui/common/colours.h"

namespace trephine {

namespace {

// An arc with an arrow head at its end, in a 24 x 24 box; mirrored for redo.
QPainterPath turn(double start_deg, double sweep_deg) {
  QPainterPath path;
  const QRectF circle(5, 6, 14, 14);
  path.arcMoveTo(circle, start_deg);
  path.arcTo(circle, start_deg, sweep_deg);
  return path;
}

void paintSymbol(QPainter& p, Symbol symbol, const QColor& colour) {
  p.setPen(QPen(colour, 2.0, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  p.setBrush(Qt::NoBrush);
  switch (symbol) {
    case Symbol::open:
      p.drawPolyline(QPolygonF({{3, 19}, {3, 5}, {9, 5}, {11, 8}, {21, 8}, {21, 19}, {3, 19}}));
      break;
    case Symbol::start:
      p.setBrush(colour);
      p.drawPolygon(QPolygonF({{7, 4}, {20, 12}, {7, 20}}));
      break;
    case Symbol::stop:
      p.setBrush(colour);
      p.drawRoundedRect(QRectF(6, 6, 12, 12), 1, 1);
      break;
    case Symbol::pause:
      p.setPen(QPen(colour, 4.0, Qt::SolidLine, Qt::FlatCap));
      p.drawLine(8, 5, 8, 19);
      p.drawLine(16, 5, 16, 19);
      break;
    case Symbol::redo:
      p.translate(24, 0);
      p.scale(-1, 1);
      [[fallthrough]];
    case Symbol::undo:
      p.drawPath(turn(150, -220));
      p.drawPolyline(QPolygonF({{5, 3}, {5.5, 9.5}, {12, 9.5}}));
      break;
    case Symbol::reset:
      p.drawPath(turn(60, 300));
      p.drawPolyline(QPolygonF({{15.5, 2.5}, {15.8, 7}, {20.5, 7}}));
      break;
    case Symbol::back:
      p.setBrush(colour);
      p.drawPolygon(QPolygonF({{11, 6}, {11, 18}, {3, 12}}));
      p.drawPolygon(QPolygonF({{20, 6}, {20, 18}, {12, 12}}));
      break;
    case Symbol::picture:
      p.drawRoundedRect(QRectF(3, 7, 18, 13), 2, 2);
      p.drawEllipse(QPointF(12, 13.5), 3.5, 3.5);
      p.drawPolyline(QPolygonF({{8, 7}, {9.5, 4}, {14.5, 4}, {16, 7}}));
      break;
    case Symbol::save:
      p.drawLine(12, 3, 12, 14);
      p.drawPolyline(QPolygonF({{7, 10}, {12, 15}, {17, 10}}));
      p.drawPolyline(QPolygonF({{4, 16}, {4, 20}, {20, 20}, {20, 16}}));
      break;
    case Symbol::cases:
      p.drawRoundedRect(QRectF(3, 4, 8, 7), 1, 1);
      p.drawRoundedRect(QRectF(13, 4, 8, 7), 1, 1);
      p.drawRoundedRect(QRectF(3, 13, 8, 7), 1, 1);
      p.drawRoundedRect(QRectF(13, 13, 8, 7), 1, 1);
      break;
    case Symbol::prepare:
      for (const auto& [y, x] : {std::pair{6.0, 15.0}, {12.0, 8.0}, {18.0, 13.0}}) {
        p.drawLine(QPointF(3, y), QPointF(21, y));
        p.setBrush(colour);
        p.drawEllipse(QPointF(x, y), 2.0, 2.0);
        p.setBrush(Qt::NoBrush);
      }
      break;
    case Symbol::train:
      p.drawPolyline(QPolygonF({{20, 3}, {10, 13}}));
      p.drawPolyline(QPolygonF({{20, 3}, {12, 15}, {10, 13}}));
      p.drawPolyline(QPolygonF({{3, 20}, {9, 18.5}, {15, 20}, {21, 18.5}}));
      break;
    case Symbol::review:
      p.drawPolyline(QPolygonF({{3, 4}, {3, 20}, {21, 20}}));
      p.drawPolyline(QPolygonF({{6, 16}, {10, 11}, {14, 13}, {20, 6}}));
      break;
    case Symbol::settings:
      p.drawEllipse(QPointF(12, 12), 3.5, 3.5);
      for (int i = 0; i < 8; ++i) {
        p.save();
        p.translate(12, 12);
        p.rotate(45.0 * i);
        p.drawLine(QPointF(0, -6.5), QPointF(0, -9.5));
        p.restore();
      }
      break;
    case Symbol::view:
      p.drawPolygon(QPolygonF({{12, 3}, {20, 7.5}, {20, 16.5}, {12, 21}, {4, 16.5}, {4, 7.5}}));
      p.drawPolyline(QPolygonF({{4, 7.5}, {12, 12}, {20, 7.5}}));
      p.drawLine(12, 12, 12, 21);
      break;
  }
}

QPixmap pixmap(Symbol symbol, const QColor& colour, double scale) {
  QPixmap pixmap(int(24 * scale), int(24 * scale));
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.scale(scale, scale);
  paintSymbol(painter, symbol, colour);
  return pixmap;
}

QColor symbolColour(Symbol symbol) {
  if (symbol == Symbol::start) return colours::kGood;
  if (symbol == Symbol::stop) return colours::kBad;
  return colours::kText;
}

}  // namespace

QIcon symbolIcon(Symbol symbol) {
  QIcon icon;
  for (double scale : {1.0, 2.0, 3.0}) {
    icon.addPixmap(pixmap(symbol, symbolColour(symbol), scale));
    icon.addPixmap(pixmap(symbol, colours::kLine, scale), QIcon::Disabled);
  }
  return icon;
}

}  // namespace trephine
