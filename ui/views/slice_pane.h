// Draws one slice in its true proportions on black, with the patient's letters at its edges and a
// scale bar; middle drag shifts it, Ctrl+wheel and right drag zoom it, and where a subclass gives
// its keys to zoomKey(), + and - zoom it and 0 fits it in again.
// What the slice is, and what lies over it, is its subclasses' matter.
#pragma once

#include <QPainter>
#include <QWidget>
#include <optional>

#include "ui/views/slice_plane.h"

namespace trephine {

class SlicePane : public QWidget {
  Q_OBJECT
 public:
  explicit SlicePane(QWidget* parent = nullptr);

  // Where all of the slice is drawn in the widget; empty without one.
  QRectF target() const;
  // Pixel (x, y) of the slice, as it is drawn, covers [x, x + 1) x [y, y + 1).
  // Without a slice: (0, 0).
  QPointF toSlice(const QPointF& in_widget) const;
  QPointF toWidget(const QPointF& in_slice) const;
  // Larger by the factor around a point of the widget.
  void zoomAt(const QPointF& in_widget, double factor);
  void fit();
  // 0 without a slice.
  double pixelsPerMm() const {
    return hasSlice() ? target().width() / (shape_.width() * pixel_mm_.width()) : 0.0;
  }

 protected:
  // So many pixels of that size. An empty size: no slice, only the message, which a slice hides.
  // Zoom and shift stay: fit() for another slice. These three repaint.
  void setShape(const QSize& pixels, const QSizeF& pixel_mm);
  // Unit directions, LPS, to the right and down as drawn; none: no letters.
  void setEdges(const std::optional<std::array<Vec3, 2>>& right_down);
  void setMessage(const QString& text);
  const QSize& shape() const { return shape_; }
  bool hasSlice() const { return !shape_.isEmpty(); }

  // In the widget's coordinates, not clipped: the slice into target(). Only where there is one.
  virtual void paintSlice(QPainter& painter) = 0;
  virtual void paintOver(QPainter&) {}

  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  bool zoomKey(int key);  // whether it was one

 private:
  void paintLetters(QPainter& painter) const;
  void paintScaleBar(QPainter& painter) const;

  QSize shape_;
  QSizeF pixel_mm_{1.0, 1.0};
  std::optional<std::array<Vec3, 2>> right_down_;
  QString message_;
  double zoom_ = 1.0;  // 1: fits
  QPointF shift_;      // of the slice's middle from the widget's, in widget pixels at zoom 1
  QPointF last_, zoom_around_;
};

// Where a place of a slice of that shape is drawn, all of which is drawn in `box`.
QPointF inBox(const QRectF& box, const QSize& shape, const QPointF& in_slice);
// Words that can be read on black and on bone alike.
void paintWords(QPainter& painter, const QRectF& inside, int alignment, const QString& words,
                const QColor& colour);
// Lines that can be seen on any picture: dark and broader by `rim` first, then with the pen.
template <class Draw>
void drawRimmed(QPainter& painter, const QPen& pen, double rim, const Draw& draw) {
  painter.setBrush(Qt::NoBrush);
  if (rim > 0.0) {
    painter.setPen(QPen(QColor(0, 0, 0, 180), pen.widthF() + rim, pen.style()));
    draw();
  }
  painter.setPen(pen);
  draw();
}

}  // namespace trephine
