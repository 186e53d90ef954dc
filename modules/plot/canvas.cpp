#include "plot/canvas.h"

#include <QFont>
#include <QFontMetricsF>
#include <QLineF>
#include <QList>
#include <QPen>
#include <QPolygonF>
#include <QString>
#include <algorithm>

#include "base/tr.h"
#include "plot/clip.h"

namespace trephine::plot {

namespace {

constexpr double kEdge = 10.0;  // no text comes closer to the picture's edge
constexpr double kSmallest = 10.0;

QFont fontOf(const Font& font) {
  QFont result("DejaVu Sans");  // or what the machine has instead
  result.setPixelSize(std::max(1, int(font.size_px)));
  result.setBold(font.bold);
  result.setHintingPreference(QFont::PreferNoHinting);
  // Grey edges, the same on every machine.
  result.setStyleStrategy(
      QFont::StyleStrategy(QFont::PreferAntialias | QFont::NoSubpixelAntialias));
  return result;
}

QPolygonF polygonOf(const std::vector<QPointF>& points) {
  return QPolygonF(QList<QPointF>(points.begin(), points.end()));
}

}  // namespace

Canvas::Canvas(QImage& image, Theme theme)
    : theme_(theme), colours_(coloursOf(theme)), whole_(image.rect()) {
  image.fill(colours_.background);
  painter_.begin(&image);
  painter_.setRenderHint(QPainter::Antialiasing);
}

QSizeF Canvas::sizeOf(const std::string& text, const Font& font) const {
  const QFontMetricsF metrics(fontOf(font));
  return {metrics.horizontalAdvance(QString::fromStdString(text)),
          metrics.capHeight() + 2.0 * metrics.descent()};
}

Font Canvas::fitting(const std::string& text, Font font, double room) const {
  while (font.size_px > kSmallest && sizeOf(text, font).width() > room) font.size_px -= 1.0;
  return font;
}

std::string Canvas::shortened(const std::string& text, const Font& font, double room) const {
  return QFontMetricsF(fontOf(font))
      .elidedText(QString::fromStdString(text), Qt::ElideRight, std::max(room, 0.0))
      .toStdString();
}

void Canvas::drawAt(const QPointF& centre, const QSizeF& size, const std::string& text,
                    const Font& font, const QColor& colour) {
  const QFont with = fontOf(font);
  painter_.setFont(with);
  painter_.setPen(colour);
  painter_.drawText(
      QPointF(centre.x() - 0.5 * size.width(), centre.y() + 0.5 * QFontMetricsF(with).capHeight()),
      QString::fromStdString(text));
}

void Canvas::text(const QPointF& at, Side side, const std::string& text, const Font& font,
                  const QColor& colour, double room) {
  const std::string shown = shortened(text, font, std::min(room, whole_.width() - 2.0 * kEdge));
  const QSizeF size = sizeOf(shown, font);
  double left = at.x();
  if (side == Side::centre) left -= 0.5 * size.width();
  if (side == Side::right) left -= size.width();
  left = std::clamp(left, kEdge, std::max(kEdge, whole_.right() - kEdge - size.width()));
  const QRectF rect(QPointF(left, at.y() - 0.5 * size.height()), size);
  drawAt(rect.center(), size, shown, font, colour);
  if (!shown.empty()) texts_.push_back({shown, rect});
}

void Canvas::turnedText(const QPointF& at, const std::string& text, const Font& font,
                        const QColor& colour, double room) {
  const std::string shown = shortened(text, font, room);
  const QSizeF size = sizeOf(shown, font);
  painter_.save();
  painter_.translate(at);
  painter_.rotate(-90.0);
  drawAt({0.0, 0.0}, size, shown, font, colour);
  painter_.restore();
  const QSizeF upright = size.transposed();
  if (!shown.empty()) {
    texts_.push_back(
        {shown, {at - QPointF(0.5 * upright.width(), 0.5 * upright.height()), upright}});
  }
}

void Canvas::plate(const QRectF& rect, const QColor& colour) {
  painter_.fillRect(rect, colour);
}

void Canvas::line(const std::vector<QPointF>& points, const QColor& colour, double width_px,
                  const std::vector<double>& dashes_px) {
  if (points.size() == 1) {
    disc(points[0], 0.5 * width_px + 1.0, colour);
    return;
  }
  painter_.setBrush(Qt::NoBrush);
  // Dash by dash and segment by segment: Qt takes seconds to minutes for the outline of a polyline
  // of some thousand points.
  if (!dashes_px.empty()) {
    painter_.setPen(QPen(colour, width_px, Qt::SolidLine, Qt::FlatCap, Qt::RoundJoin));
    for (const auto& dash : dashed(points, dashes_px)) painter_.drawPolyline(polygonOf(dash));
    return;
  }
  QList<QLineF> segments;
  for (std::size_t i = 1; i < points.size(); ++i) segments.push_back({points[i - 1], points[i]});
  painter_.setPen(QPen(colour, width_px, Qt::SolidLine, Qt::SquareCap));
  painter_.drawLines(segments);
}

void Canvas::cell(const QRectF& rect, Shape shape, const QColor& fill) {
  painter_.setPen(QPen(colours_.edge, 1.0));
  painter_.setBrush(fill);
  if (shape == Shape::rectangle) {
    painter_.drawRect(rect);
  } else if (shape == Shape::pill) {
    const double r = 0.5 * std::min(rect.width(), rect.height());
    painter_.drawRoundedRect(rect, r, r);
  } else {
    const double tip = std::min(0.25 * rect.height(), 0.15 * rect.width());
    painter_.drawPolygon(polygonOf({{rect.left(), rect.center().y()},
                                    {rect.left() + tip, rect.top()},
                                    {rect.right() - tip, rect.top()},
                                    {rect.right(), rect.center().y()},
                                    {rect.right() - tip, rect.bottom()},
                                    {rect.left() + tip, rect.bottom()}}));
  }
}

void Canvas::disc(const QPointF& centre, double radius, const QColor& fill) {
  painter_.setPen(Qt::NoPen);
  painter_.setBrush(fill);
  painter_.drawEllipse(centre, radius, radius);
}

void Canvas::area(const std::vector<QPointF>& outline, const QColor& fill) {
  painter_.setPen(Qt::NoPen);
  painter_.setBrush(fill);
  painter_.drawPolygon(polygonOf(outline));
}

void Canvas::frame(const QRectF& rect, const QColor& colour) {
  painter_.setPen(QPen(colour, 1.0));
  painter_.setBrush(Qt::NoBrush);
  painter_.drawRect(rect.adjusted(-0.5, -0.5, 0.5, 0.5));  // on whole pixels, outside
}

}  // namespace trephine::plot
