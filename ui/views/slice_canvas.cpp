#include "ui/views/slice_canvas.h"

#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <cmath>

#include "ui/common/colours.h"

namespace trephine {

SliceCanvas::SliceCanvas(QWidget* parent) : SlicePane(parent) {
  setMinimumSize(200, 200);
}

void SliceCanvas::draw() {
  image_ = windowed(slice_, window_).mirrored(mirroring_.across, mirroring_.down);
  setShape(image_.size(), {slice_.spacing_mm.x, slice_.spacing_mm.y});
}

void SliceCanvas::setDirection(const std::optional<Mat3>& direction) {
  mirroring_ = direction ? mirroringOf(*direction) : Mirroring{};
  if (!direction) return setEdges({});
  setEdges({{(mirroring_.across ? -1.0 : 1.0) * (*direction)[0],
             (mirroring_.down ? -1.0 : 1.0) * (*direction)[1]}});
}

void SliceCanvas::setSlice(SlicePicture slice) {
  slice_ = std::move(slice);
  SlicePane::setMessage({});
  marked_ = {};
  draw();
}

void SliceCanvas::setWindow(const HuWindow& window) {
  window_ = window;
  draw();
}

void SliceCanvas::setMessage(const QString& text) {
  slice_ = {};
  marked_ = {};
  draw();
  SlicePane::setMessage(text);
}

void SliceCanvas::setKept(std::optional<QRect> pixels) {
  kept_ = pixels;
  update();
}

void SliceCanvas::setMarked(const QImage& mask) {
  marked_ = mask.mirrored(mirroring_.across, mirroring_.down);
  update();
}

void SliceCanvas::setDrawable(bool drawable) {
  drawable_ = drawable;
  setCursor(drawable ? Qt::CrossCursor : Qt::ArrowCursor);
}

QPoint SliceCanvas::pixelAt(const QPointF& position) const {
  const QPointF drawn = toSlice(position);
  const double x = mirroring_.across ? slice_.columns - drawn.x() : drawn.x();
  const double y = mirroring_.down ? slice_.rows - drawn.y() : drawn.y();
  return {std::clamp(int(std::floor(x)), 0, slice_.columns - 1),
          std::clamp(int(std::floor(y)), 0, slice_.rows - 1)};
}

QRectF SliceCanvas::inWidget(const QRect& pixels) const {
  const int x = mirroring_.across ? slice_.columns - pixels.left() - pixels.width() : pixels.left();
  const int y = mirroring_.down ? slice_.rows - pixels.top() - pixels.height() : pixels.top();
  return {toWidget(QPointF(x, y)), toWidget(QPointF(x + pixels.width(), y + pixels.height()))};
}

void SliceCanvas::paintSlice(QPainter& painter) {
  painter.drawImage(target(), image_);
  if (!marked_.isNull()) {
    QImage tint(marked_.size(), QImage::Format_ARGB32_Premultiplied);
    tint.fill(colours::kCaution);
    QPainter mask(&tint);
    mask.setCompositionMode(QPainter::CompositionMode_DestinationIn);
    mask.drawImage(0, 0, marked_);
    mask.end();
    painter.setOpacity(0.7);
    painter.drawImage(target(), tint);
    painter.setOpacity(1.0);
  }
  if (kept_) paintKept(painter);
}

void SliceCanvas::paintKept(QPainter& painter) const {
  const QRectF kept = inWidget(*kept_);
  QPainterPath outside;
  outside.addRect(target());
  if (!kept_->isEmpty()) outside.addRect(kept);
  painter.fillPath(outside, QColor(0, 0, 0, 150));
  if (kept_->isEmpty()) return;
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(colours::kAccent, 1.5));
  painter.drawRect(kept);
}

void SliceCanvas::mousePressEvent(QMouseEvent* event) {
  pressed_.reset();
  windowing_.reset();
  SlicePane::mousePressEvent(event);
  if (image_.isNull() || event->button() != Qt::LeftButton) return;
  if (!drawable_) {
    windowing_ = event->position();
    window_before_ = window_;
  } else if (target().contains(event->position())) {
    pressed_ = pixelAt(event->position());
  }
}

void SliceCanvas::mouseMoveEvent(QMouseEvent* event) {
  const bool left = event->buttons() & Qt::LeftButton;
  if (windowing_ && left && !image_.isNull()) {
    const QPointF moved = event->position() - *windowing_;
    if (moved.isNull()) return;
    setWindow(draggedWindow(window_before_, moved.x(), moved.y()));
    emit windowDragged(window_);
    return;
  }
  if (!pressed_ || !left || image_.isNull()) {
    return SlicePane::mouseMoveEvent(event);
  }
  const QPoint from = *pressed_, to = pixelAt(event->position());
  if (to == from) return;
  emit boxDrawn(QRect(QPoint(std::min(from.x(), to.x()), std::min(from.y(), to.y())),
                      QPoint(std::max(from.x(), to.x()), std::max(from.y(), to.y()))));
}

}  // namespace trephine
