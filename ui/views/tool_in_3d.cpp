#include "ui/views/tool_in_3d.h"

#include <QPainter>
#include <QPixmap>
#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "ui/views/device_pixels.h"
#include "ui/views/slice_plane.h"

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

ToolIn3D::ToolIn3D(Toolbox& toolbox, const SceneRenderer& renderer, const ViewStrip& strip,
                   QWidget& view)
    : toolbox_(toolbox), renderer_(renderer), strip_(strip), view_(view) {
  connect(&toolbox_, &Toolbox::taken, this, &ToolIn3D::showCursor);
  connect(&toolbox_, &Toolbox::changed, this, &ToolIn3D::showCursor);
  connect(&strip_, &ViewStrip::lightToggled, this, &ToolIn3D::showCursor);
}

void ToolIn3D::setTissues(const TissueSet& tissues, const TissueLooks& looks) {
  tissues_ = tissues;
  looks_ = looks;
}

void ToolIn3D::setTraining(bool training) {
  training_ = training;
  if (training) release();
  showCursor();
}

// A brush is a ring as wide as it paints on what is under the pointer.
void ToolIn3D::showCursor() {
  if (!strip_.movesLight() && !isInHand()) return view_.setCursor(Qt::ArrowCursor);
  const double ring_mm = isInHand() ? toolbox_.inHand().ring_mm() : 0.0;
  const std::optional<Picked> picked = ring_mm > 0.0 ? pickAt(pointer_) : std::nullopt;
  if (!picked) return view_.setCursor(Qt::CrossCursor);
  const double ratio = view_.devicePixelRatioF();
  const int radius = int(std::lround(ring_mm / (renderer_.mmPerPixelAt(picked->at_mm) * ratio)));
  if (radius > kMostRing) return view_.setCursor(Qt::CrossCursor);
  const bool ring_already = view_.cursor().shape() == Qt::BitmapCursor && radius == ring_;
  if (!ring_already) view_.setCursor(ringCursor(std::max(2, radius), ratio));
  ring_ = radius;
}

std::optional<ViewCamera::Ray> ToolIn3D::rayAt(const QPointF& place) const {
  if (!renderer_.hasVolume()) return {};
  const QSize all = pixelsOf(view_);
  return renderer_.camera().rayThrough(pixelAt(view_, place), all.width(), all.height());
}

std::optional<Picked> ToolIn3D::pickAt(const QPointF& place) const {
  const std::optional<ViewCamera::Ray> ray = rayAt(place);
  if (!ray) return {};
  const std::shared_ptr<const LabelMap>& labels =
      stroke_labels_ ? stroke_labels_ : mirror_->labels();
  return pick(mirror_->volume(), labels.get(), tissues_, looks_, strip_.planes(), *ray);
}

double ToolIn3D::mmPerUnitAt(const QPointF& place) const {
  const std::optional<Picked> picked = pickAt(place);
  return renderer_.mmPerPixelAt(picked ? picked->at_mm : renderer_.camera().focus()) *
         view_.devicePixelRatioF();
}

std::optional<ToolEvent> ToolIn3D::eventHere(const QPointF& moved) const {
  const std::optional<Picked> picked = pickAt(pointer_);
  if (!picked) return {};
  ToolEvent event;
  event.at_mm = picked->at_mm;
  event.inside_mm = picked->inside_mm;
  event.across = axisAlong(renderer_.copy().geometry, renderer_.viewForward());
  event.moved_mm = std::hypot(moved.x(), moved.y()) * view_.devicePixelRatioF() *
                   renderer_.mmPerPixelAt(picked->at_mm);
  event.in_widget = pointer_;
  return event;
}

// A stroke goes over what was seen when it began: else a brush would climb towards the eye on what
// it has painted, and an eraser would drill.
void ToolIn3D::press() {
  const std::optional<ToolEvent> at = eventHere();
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

bool ToolIn3D::move(const QPointF& moved) {
  if (!used_) return false;
  if (const auto at = eventHere(moved)) used_->move(last_use_ = *at);
  return true;
}

void ToolIn3D::release() {
  stroke_labels_.reset();
  if (ViewTool* tool = std::exchange(used_, nullptr)) tool->release(last_use_);
}

bool ToolIn3D::key(int key) {
  if (training_ || !renderer_.hasVolume()) return false;
  if (isInHand() && toolbox_.useKey(key, nullptr)) return true;
  if (toolbox_.takeByKey(key, true)) return true;
  const bool of_tool = key == Qt::Key_Return || key == Qt::Key_Enter ||
                       key == Qt::Key_BracketLeft || key == Qt::Key_BracketRight;
  return (!of_tool || isInHand()) && toolbox_.other_keys(key);
}

}  // namespace trephine
