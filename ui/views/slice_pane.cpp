#include "ui/views/slice_pane.h"

#include <QMouseEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>

#include "ui/common/colours.h"
#include "ui/views/steps.h"

namespace trephine {

namespace {
constexpr double kLeastZoom = 0.25, kMostZoom = 64.0;
constexpr double kZoomPerPixel = 0.008;  // of a drag, natural logarithm
}  // namespace

QPointF inBox(const QRectF& box, const QSize& shape, const QPointF& in_slice) {
  if (box.isEmpty()) return {};
  return {box.left() + in_slice.x() / shape.width() * box.width(),
          box.top() + in_slice.y() / shape.height() * box.height()};
}

void paintWords(QPainter& painter, const QRectF& inside, int alignment, const QString& words,
                const QColor& colour) {
  painter.setPen(QColor(0, 0, 0, 220));
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) painter.drawText(inside.translated(x, y), alignment, words);
  }
  painter.setPen(colour);
  painter.drawText(inside, alignment, words);
}

SlicePane::SlicePane(QWidget* parent) : QWidget(parent) {
  setAutoFillBackground(false);
  setAttribute(Qt::WA_OpaquePaintEvent);
}

void SlicePane::setShape(const QSize& pixels, const QSizeF& pixel_mm) {
  shape_ = pixels;
  pixel_mm_ = pixel_mm;
  update();
}

void SlicePane::setEdges(const std::optional<std::array<Vec3, 2>>& right_down) {
  right_down_ = right_down;
  update();
}

void SlicePane::setMessage(const QString& text) {
  message_ = text;
  update();
}

QRectF SlicePane::target() const {
  if (!hasSlice() || width() <= 0 || height() <= 0) return {};
  QSizeF size(shape_.width() * pixel_mm_.width(), shape_.height() * pixel_mm_.height());
  size.scale(QSizeF(this->size()), Qt::KeepAspectRatio);
  size *= zoom_;
  const QPointF middle = QRectF(rect()).center() + shift_ * zoom_;
  return {middle - QPointF(size.width(), size.height()) / 2.0, size};
}

QPointF SlicePane::toSlice(const QPointF& in_widget) const {
  const QRectF box = target();
  if (box.isEmpty()) return {};
  return {(in_widget.x() - box.left()) / box.width() * shape_.width(),
          (in_widget.y() - box.top()) / box.height() * shape_.height()};
}

QPointF SlicePane::toWidget(const QPointF& in_slice) const {
  return inBox(target(), shape_, in_slice);
}

void SlicePane::zoomAt(const QPointF& in_widget, double factor) {
  if (!hasSlice()) return;
  const QPointF place = toSlice(in_widget);
  zoom_ = std::clamp(zoom_ * factor, kLeastZoom, kMostZoom);
  shift_ += (in_widget - toWidget(place)) / zoom_;
  update();
}

void SlicePane::fit() {
  zoom_ = 1.0;
  shift_ = {};
  update();
}

bool SlicePane::zoomKey(int key) {
  const QPointF middle = QRectF(rect()).center();
  if (key == Qt::Key_Plus || key == Qt::Key_Equal) {
    zoomAt(middle, kZoomStep);
  } else if (key == Qt::Key_Minus) {
    zoomAt(middle, 1.0 / kZoomStep);
  } else if (key == Qt::Key_0) {
    fit();
  } else {
    return false;
  }
  return true;
}

void SlicePane::mousePressEvent(QMouseEvent* event) {
  last_ = zoom_around_ = event->position();
  if (event->button() == Qt::LeftButton) event->ignore();
}

void SlicePane::mouseMoveEvent(QMouseEvent* event) {
  const QPointF moved = event->position() - last_;
  last_ = event->position();
  if (event->buttons() & Qt::MiddleButton) {
    shift_ += moved / zoom_;
    update();
  } else if (event->buttons() & Qt::RightButton) {
    zoomAt(zoom_around_, std::exp(-kZoomPerPixel * moved.y()));
  } else {
    event->ignore();
  }
}

void SlicePane::wheelEvent(QWheelEvent* event) {
  if (!(event->modifiers() & Qt::ControlModifier)) return event->ignore();
  zoomAt(event->position(), std::pow(kZoomStep, event->angleDelta().y() / kWheelNotch));
  event->accept();
}

void SlicePane::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), Qt::black);
  if (!hasSlice()) {
    painter.setPen(colours::kOnPicture);
    painter.drawText(rect().adjusted(24, 24, -24, -24), Qt::AlignCenter | Qt::TextWordWrap,
                     message_);
    return;
  }
  if (target().isEmpty()) return;
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  paintSlice(painter);
  paintOver(painter);
  painter.setRenderHint(QPainter::Antialiasing, false);
  paintScaleBar(painter);
  if (right_down_) paintLetters(painter);
}

void SlicePane::paintLetters(QPainter& painter) const {
  const auto [right, down] = *right_down_;
  const QRectF inside = QRectF(rect()).adjusted(6, 4, -6, -4);
  const auto letter = [&](int alignment, const Vec3& towards) {
    paintWords(painter, inside, alignment, QString(QLatin1Char(patientLetter(towards))),
               colours::kOnPicture);
  };
  letter(Qt::AlignRight | Qt::AlignVCenter, right);
  letter(Qt::AlignLeft | Qt::AlignVCenter, -right);
  letter(Qt::AlignBottom | Qt::AlignHCenter, down);
  letter(Qt::AlignTop | Qt::AlignHCenter, -down);
}

// As long as 1, 2 or 5 times a power of ten fits into a quarter of the width.
void SlicePane::paintScaleBar(QPainter& painter) const {
  const double scale = pixelsPerMm();
  const double most_mm = 0.25 * width() / scale;
  if (!(scale > 0.0) || !std::isfinite(most_mm) || most_mm <= 0.0 || width() < 120) return;
  const double ten = std::pow(10.0, std::floor(std::log10(most_mm)));
  const double mm = most_mm >= 5.0 * ten ? 5.0 * ten : most_mm >= 2.0 * ten ? 2.0 * ten : ten;
  const double right = width() - 8.0, y = height() - 7.0;
  const double left = right - std::round(mm * scale);  // of whole pixels, the nearest length
  const auto bar = [&](const QColor& colour, double thick) {
    painter.setPen(QPen(colour, thick));
    painter.drawLine(QPointF(left, y), QPointF(right, y));
    for (double x : {left, right}) painter.drawLine(QPointF(x, y - 3.0), QPointF(x, y + 3.0));
  };
  bar(QColor(0, 0, 0, 200), 3.0);
  bar(colours::kOnPicture, 1.0);
  paintWords(painter, QRectF(left - 60.0, y - 24.0, right - left + 60.0, 20.0),
             Qt::AlignRight | Qt::AlignBottom, tr("%1 mm").arg(mm), colours::kOnPicture);
}

}  // namespace trephine
