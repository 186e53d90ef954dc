// The painter of one picture: lines, cells and texts, which it remembers. Internal to the room.
#pragma once

#include <QColor>
#include <QImage>
#include <QPainter>
#include <QPointF>
#include <QRectF>
#include <QSizeF>
#include <string>
#include <vector>

#include "plot/drawing.h"

namespace trephine::plot {

struct Font {
  double size_px = 16.0;
  bool bold = false;
};

enum class Side { left, centre, right };  // of the text, that its position is

class Canvas {
 public:
  Canvas(QImage& image, Theme theme);

  const Colours& colours() const { return colours_; }
  QColor colour(Tone tone) const { return colourOf(tone, theme_); }
  const std::vector<PlacedText>& texts() const { return texts_; }

  QSizeF sizeOf(const std::string& text, const Font& font) const;
  // The font, or the largest smaller one with which the text is at most `room` wide; 10 px at
  // least.
  Font fitting(const std::string& text, Font font, double room) const;

  // Vertically centred on `at`, kept within the picture, cut to `room` with an ellipsis. Where it
  // came to stand is kept in texts().
  void text(const QPointF& at, Side side, const std::string& text, const Font& font,
            const QColor& colour, double room = 1e6);
  // Upwards, centred on `at`.
  void turnedText(const QPointF& at, const std::string& text, const Font& font,
                  const QColor& colour, double room);
  void plate(const QRectF& rect, const QColor& colour);

  // Dashes in pixels, ink and gap in turn. One point is a dot.
  void line(const std::vector<QPointF>& points, const QColor& colour, double width_px,
            const std::vector<double>& dashes_px = {});
  void cell(const QRectF& rect, Shape shape, const QColor& fill);
  void disc(const QPointF& centre, double radius, const QColor& fill);
  void area(const std::vector<QPointF>& outline, const QColor& fill);
  void frame(const QRectF& rect, const QColor& colour);

 private:
  std::string shortened(const std::string& text, const Font& font, double room) const;
  void drawAt(const QPointF& centre, const QSizeF& size, const std::string& text, const Font& font,
              const QColor& colour);

  Theme theme_;
  Colours colours_;
  QRectF whole_;
  QPainter painter_;
  std::vector<PlacedText> texts_;
};

}  // namespace trephine::plot
