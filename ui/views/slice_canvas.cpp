#include "ui/views/slice_canvas.h"

#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <cmath>

#include "ui/common/colours.h"

namespace trephine {

namespace {

// Where in the patient the direction mostly points.
QChar letterOf(const Vec3& v) {
  const int axis = mainAxis(v);
  return QLatin1Char((v[axis] > 0.0 ? "LPS" : "RAI")[axis]);
}

}  // namespace

SliceCanvas::SliceCanvas(QWidget* parent) : QWidget(parent) {
  setMinimumSize(200, 200);
  setAutoFillBackground(false);
}

void SliceCanvas::draw() {
  image_ = windowed(slice_, window_).mirrored(mirroring_.across, mirroring_.down);
  update();
}

void SliceCanvas::setDirection(const std::optional<Mat3>& direction) {
  direction_ = direction;
  mirroring_ = direction ? mirroringOf(*direction) : Mirroring{};
}

void SliceCanvas::setSlice(SlicePicture slice) {
  slice_ = std::move(slice);
  message_.clear();
  marked_ = {};
  draw();
}

void SliceCanvas::setWindow(const HuWindow& window) {
  window_ = window;
  draw();
}

void SliceCanvas::setMessage(const QString& text) {
  slice_ = {};
  message_ = text;
  marked_ = {};
  draw();
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

QRectF SliceCanvas::target() const {
  if (image_.isNull()) return {};
  QSizeF size(slice_.columns * slice_.spacing_mm.x, slice_.rows * slice_.spacing_mm.y);
  size.scale(QSizeF(this->size()), Qt::KeepAspectRatio);
  return {QPointF((width() - size.width()) / 2.0, (height() - size.height()) / 2.0), size};
}

QPoint SliceCanvas::pixelAt(const QPointF& position) const {
  const QRectF box = target();
  double x = (position.x() - box.left()) / box.width() * slice_.columns;
  double y = (position.y() - box.top()) / box.height() * slice_.rows;
  if (mirroring_.across) x = slice_.columns - x;
  if (mirroring_.down) y = slice_.rows - y;
  return {std::clamp(int(std::floor(x)), 0, slice_.columns - 1),
          std::clamp(int(std::floor(y)), 0, slice_.rows - 1)};
}

QRectF SliceCanvas::inWidget(const QRect& pixels) const {
  const QRectF box = target();
  const double sx = box.width() / slice_.columns, sy = box.height() / slice_.rows;
  const int x = mirroring_.across ? slice_.columns - pixels.left() - pixels.width() : pixels.left();
  const int y = mirroring_.down ? slice_.rows - pixels.top() - pixels.height() : pixels.top();
  return {box.left() + x * sx, box.top() + y * sy, pixels.width() * sx, pixels.height() * sy};
}

void SliceCanvas::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), Qt::black);
  if (image_.isNull()) {
    painter.setPen(colours::kQuiet);
    painter.drawText(rect().adjusted(24, 24, -24, -24), Qt::AlignCenter | Qt::TextWordWrap,
                     message_);
    return;
  }
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  painter.drawImage(target(), image_);
  if (!marked_.isNull()) {
    QImage tint(marked_.size(), QImage::Format_ARGB32_Premultiplied);
    QColor colour = colours::kCaution;
    tint.fill(colour);
    QPainter mask(&tint);
    mask.setCompositionMode(QPainter::CompositionMode_DestinationIn);
    mask.drawImage(0, 0, marked_);
    mask.end();
    painter.setOpacity(0.7);
    painter.drawImage(target(), tint);
    painter.setOpacity(1.0);
  }
  if (kept_) paintKept(painter);
  if (direction_) paintLetters(painter);
}

void SliceCanvas::paintLetters(QPainter& painter) const {
  const Vec3 right = (mirroring_.across ? -1.0 : 1.0) * (*direction_)[0];
  const Vec3 down = (mirroring_.down ? -1.0 : 1.0) * (*direction_)[1];
  const QRect inside = rect().adjusted(6, 4, -6, -4);
  painter.setPen(colours::kQuiet);
  painter.drawText(inside, Qt::AlignRight | Qt::AlignVCenter, letterOf(right));
  painter.drawText(inside, Qt::AlignLeft | Qt::AlignVCenter, letterOf(-right));
  painter.drawText(inside, Qt::AlignBottom | Qt::AlignHCenter, letterOf(down));
  painter.drawText(inside, Qt::AlignTop | Qt::AlignHCenter, letterOf(-down));
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
  if (!drawable_ || image_.isNull() || event->button() != Qt::LeftButton) {
    return QWidget::mousePressEvent(event);
  }
  if (target().contains(event->position())) pressed_ = pixelAt(event->position());
}

void SliceCanvas::mouseMoveEvent(QMouseEvent* event) {
  if (!pressed_ || !(event->buttons() & Qt::LeftButton) || image_.isNull()) return;
  const QPoint from = *pressed_, to = pixelAt(event->position());
  if (to == from) return;
  emit boxDrawn(QRect(QPoint(std::min(from.x(), to.x()), std::min(from.y(), to.y())),
                      QPoint(std::max(from.x(), to.x()), std::max(from.y(), to.y()))));
}

}  // namespace trephine
