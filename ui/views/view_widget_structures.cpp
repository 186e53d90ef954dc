// The tools for structures and the entry point in the 3-D view: they work at what is seen under the
// pointer.
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPixmap>
#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "ui/views/view_tools.h"
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

void ViewWidget::setTool(SliceTool tool) {
  tool_ = tool;
  if (!isBrush(tool)) endStroke();
  showCursor();
}

bool ViewWidget::hasTool() const {
  const bool places = tool_ == SliceTool::entry || tool_ == SliceTool::outline;
  return (isForStructures(tool_) || places) && !training_ && !moving_light_;
}

// A brush is a ring as wide as it paints on what is under the pointer.
void ViewWidget::showCursor() {
  if (!moving_light_ && !hasTool()) return setCursor(Qt::ArrowCursor);
  const std::optional<Picked> picked = hasTool() && isBrush(tool_) ? pickAt(last_) : std::nullopt;
  if (!picked) return setCursor(Qt::CrossCursor);
  const double mm = renderer_.mmPerPixelAt(picked->at_mm) * devicePixelRatioF();
  const int radius = int(std::lround(brush_mm_ / mm));
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

// The disc of a brush lies across the axis of the grid along which one looks most.
int ViewWidget::axisSeenAlong() const {
  int most = 0;
  const Mat3& grid = shown_.direction;
  const auto along = [&](int a) { return std::abs(glm::dot(grid[a], renderer_.viewForward())); };
  for (int axis = 1; axis < 3; ++axis) {
    if (along(axis) > along(most)) most = axis;
  }
  return most;
}

// A stroke goes over what was seen when it began: else a brush would climb towards the eye on what
// it has painted, and an eraser would drill.
void ViewWidget::useTool(const QPointF& place) {
  const std::optional<Picked> picked = pickAt(place);
  if (!picked) return emit nothingThere();
  if (tool_ == SliceTool::entry) return emit entryChosen(picked->at_mm, picked->at_mm);
  if (!isBrush(tool_)) {
    return emit structureClicked(tool_,
                                 tool_ == SliceTool::grow ? picked->inside_mm : picked->at_mm);
  }
  try {
    if (mirror_->labels()) stroke_labels_ = std::make_shared<LabelMap>(*mirror_->labels());
  } catch (const std::bad_alloc&) {
    stroke_labels_.reset();  // those that change, then
  }
  stroke_at_mm_ = picked->at_mm;
  emit strokeBegan(picked->at_mm, axisSeenAlong());
}

// What is beside an edge may lie far behind it: there another stroke begins, or a bar would run
// through the air.
void ViewWidget::moveStroke(const QPointF& from, const QPointF& to) {
  const std::optional<Picked> picked = pickAt(to);
  if (!picked) return;
  const QPointF moved = to - from;
  const double moved_mm = std::hypot(moved.x(), moved.y()) * devicePixelRatioF() *
                          renderer_.mmPerPixelAt(picked->at_mm);
  if (glm::distance(picked->at_mm, *stroke_at_mm_) > 3.0 * moved_mm + brush_mm_) {
    if (tool_ == SliceTool::wall) return;  // its end grows the preview anew
    emit strokeEnded();
    emit strokeBegan(picked->at_mm, axisSeenAlong());
  } else {
    emit strokeMoved(picked->at_mm);
  }
  stroke_at_mm_ = picked->at_mm;
}

void ViewWidget::endStroke() {
  if (!stroke_at_mm_) return;
  stroke_at_mm_.reset();
  stroke_labels_.reset();
  emit strokeEnded();
}

bool ViewWidget::toolKey(int key) {
  if (training_ || !renderer_.hasVolume()) return false;
  const bool of_tool = key == Qt::Key_Escape || key == Qt::Key_Return || key == Qt::Key_Enter ||
                       key == Qt::Key_BracketLeft || key == Qt::Key_BracketRight;
  if (tool_ == SliceTool::entry && (key == Qt::Key_Delete || key == Qt::Key_Backspace)) {
    emit entryLeft();
    return true;
  }
  if (key != Qt::Key_V && !(of_tool && hasTool())) return false;
  emit structureKey(key);
  return true;
}

}  // namespace trephine
