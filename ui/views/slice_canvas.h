// A slice as it is stored, for the importer, looked at as is customary; and what is marked in it.
// Positions are the slice's own pixels, column and row as stored.
#pragma once

#include <QImage>

#include "ui/views/slice_image.h"
#include "ui/views/slice_pane.h"

namespace trephine {

class SliceCanvas : public SlicePane {
  Q_OBJECT
 public:
  explicit SliceCanvas(QWidget* parent = nullptr);

  void setSlice(SlicePicture slice);
  // Unit directions, LPS, of columns, rows and slices; without one slices are drawn as stored.
  void setDirection(const std::optional<Mat3>& direction);
  void setWindow(const HuWindow& window);
  // In place of a slice.
  void setMessage(const QString& text);
  // What is kept of the slice, [left, right) x [top, bottom): the rest is drawn darker.
  void setKept(std::optional<QRect> pixels);
  // What would be taken out: tinted where `mask` (Format_Alpha8, a value a pixel) is opaque.
  void setMarked(const QImage& mask);
  // Whether dragging with the left button draws a box; else it sets the window, as in all slices.
  void setDrawable(bool drawable);
  const HuWindow& window() const { return window_; }

  const QImage& image() const { return image_; }  // as it is drawn
  const QImage& marked() const { return marked_; }

 signals:
  void boxDrawn(const QRect& pixels);
  void windowDragged(const trephine::HuWindow& window);

 protected:
  void paintSlice(QPainter& painter) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;

 private:
  void draw();
  QPoint pixelAt(const QPointF& position) const;
  QRectF inWidget(const QRect& pixels) const;
  void paintKept(QPainter& painter) const;

  SlicePicture slice_;
  HuWindow window_ = kWindowPresets[kFirstPreset].window;
  QImage image_, marked_;
  std::optional<QRect> kept_;
  Mirroring mirroring_;
  bool drawable_ = false;
  std::optional<QPoint> pressed_;
  std::optional<QPointF> windowing_;  // where a drag of the window began
  HuWindow window_before_;
};

}  // namespace trephine
