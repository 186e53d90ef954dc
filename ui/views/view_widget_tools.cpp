// The tool in hand in the 3-D view: it works at what is seen under the pointer.
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPixmap>
#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "ui/views/slice_plane.h"
#include "ui/views/view_strip.h"
#include "ui/views/view_widget.h"

namespace trephine {

namespace {

constexpr int kMostRing = 120;  // pixels of its radius: cursors have an end

// White with a dark rim, to be seen on any tissue.
QCursor ringCursor(int radius, double ratio) {
  const int side = 2 * radius + 5;
  QPixmap ring(QSize(side, side) * ratio);
  ring.setDevicePixelRatio(ratio);
  ring.fill(Qt::transparent);
  QPainter painter(&ring);
  painter.setRenderHint(QPainter::Antialiasing);
  const QPointF middle(side / 2.0, side / 2.0);
  for (const auto& [colour, width] : {std::pair{QColor(0, 0, 0, 160), 3.0}, {Qt::white, 1.2}}) {
    painter.setPen(QPen(colour, width));
    painter.drawEllipse(middle, radius, radius);
  }
  painter.end();
  return QCursor(ring, side / 2, side / 2);
}

}  // namespace

bool ViewWidget::hasTool() const {
  return toolbox_.inHand().worksIn3D() && !training_ && !moving_light_;
}

// A brush is a ring as wide as it paints on what is under the pointer.
void ViewWidget::showCursor() {
  if (!moving_light_ && !hasTool()) return setCursor(Qt::ArrowCursor);
  const double ring_mm = hasTool() ? toolbox_.inHand().ring_mm() : 0.0;
  const std::optional<Picked> picked = ring_mm > 0.0 ? pickAt(last_) : std::nullopt;
  if (!picked) return setCursor(Qt::CrossCursor);
  const double mm = renderer_.mmPerPixelAt(picked->at_mm) * devicePixelRatioF();
  const int radius = int(std::lround(ring_mm / mm));
  if (radius > kMostRing) return setCursor(Qt::CrossCursor);
  const bool ring_already = cursor().shape() == Qt::BitmapCursor && radius == ring_;
  if (!ring_already) setCursor(ringCursor(std::max(2, radius), devicePixelRatioF()));
  ring_ = radius;
}

std::optional<ViewCamera::Ray> ViewWidget::rayAt(const QPointF& place) const {
  if (!renderer_.hasVolume()) return {};
  const double ratio = devicePixelRatioF();
  return renderer_.camera().rayThrough(pixelAt(place), int(std::lround(width() * ratio)),
                                       int(std::lround(height() * ratio)));
}

std::optional<Picked> ViewWidget::pickAt(const QPointF& place) const {
  const std::optional<ViewCamera::Ray> ray = rayAt(place);
  if (!ray) return {};
  const std::shared_ptr<const LabelMap>& labels =
      stroke_labels_ ? stroke_labels_ : mirror_->labels();
  return pick(mirror_->volume(), labels.get(), seen_, looks_, clip_.planes(), *ray);
}

double ViewWidget::mmPerUnitAt(const QPointF& place) const {
  const std::optional<Picked> picked = pickAt(place);
  return renderer_.mmPerPixelAt(picked ? picked->at_mm : renderer_.camera().focus()) *
         devicePixelRatioF();
}

std::optional<ToolEvent> ViewWidget::eventAt(const QPointF& place, const QPointF& moved) const {
  const std::optional<Picked> picked = pickAt(place);
  if (!picked) return {};
  ToolEvent event;
  event.at_mm = picked->at_mm;
  event.inside_mm = picked->inside_mm;
  event.across = axisAlong(shown_, renderer_.viewForward());
  event.moved_mm = std::hypot(moved.x(), moved.y()) * devicePixelRatioF() *
                   renderer_.mmPerPixelAt(picked->at_mm);
  event.in_widget = place;
  return event;
}

// A stroke goes over what was seen when it began: else a brush would climb towards the eye on what
// it has painted, and an eraser would drill.
void ViewWidget::useTool() {
  const std::optional<ToolEvent> at = eventAt(last_);
  if (!at) return emit nothingThere();
  used_ = &toolbox_.inHand();
  if (used_->ring_mm() > 0.0) {
    try {
      if (mirror_->labels()) stroke_labels_ = std::make_shared<LabelMap>(*mirror_->labels());
    } catch (const std::bad_alloc&) {
      stroke_labels_.reset();  // those that change, then
    }
  }
  used_->press(last_use_ = *at);
}

void ViewWidget::endUse() {
  stroke_labels_.reset();
  if (ViewTool* tool = std::exchange(used_, nullptr)) tool->release(last_use_);
}

bool ViewWidget::toolKey(int key) {
  if (training_ || !renderer_.hasVolume()) return false;
  if (hasTool() && toolbox_.useKey(key, nullptr)) return true;
  const bool of_tool = key == Qt::Key_Return || key == Qt::Key_Enter ||
                       key == Qt::Key_BracketLeft || key == Qt::Key_BracketRight;
  return (key == Qt::Key_V || (of_tool && hasTool())) && toolbox_.other_keys(key);
}

}  // namespace trephine
