// A widget in the pixels of its screen, as the renderer counts them.
#pragma once

#include <QWidget>
#include <cmath>

#include "base/math.h"

namespace trephine {

inline QSize pixelsOf(const QWidget& widget) {
  const double ratio = widget.devicePixelRatioF();
  return {int(std::lround(widget.width() * ratio)), int(std::lround(widget.height() * ratio))};
}

// A place of the widget, from the lower left corner.
inline glm::dvec2 pixelAt(const QWidget& widget, const QPointF& place) {
  const double ratio = widget.devicePixelRatioF();
  return {place.x() * ratio, (widget.height() - place.y()) * ratio};
}

}  // namespace trephine
