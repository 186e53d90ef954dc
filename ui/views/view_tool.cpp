#include "ui/views/view_tool.h"

#include <cmath>
#include <utility>

namespace trephine {

bool isClick(const QPointF& pressed, const QPointF& released) {
  constexpr double kShortestDrag_pixels = 3.0;
  const QPointF moved = released - pressed;
  return std::hypot(moved.x(), moved.y()) < kShortestDrag_pixels;
}

ViewTool::ViewTool(Facts facts, QObject* parent) : QObject(parent), facts_(std::move(facts)) {
  setObjectName(facts_.name);
}

}  // namespace trephine
