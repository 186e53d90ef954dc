#include "plot/clip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace trephine::plot {

namespace {

// Liang and Barsky 1984: the segment's part within the rectangle.
std::optional<std::pair<QPointF, QPointF>> cut(const QPointF& a, const QPointF& b,
                                               const QRectF& area) {
  double from = 0.0, to = 1.0;
  const double dx = b.x() - a.x(), dy = b.y() - a.y();
  const auto side = [&](double towards, double distance) {
    if (towards == 0.0) return distance >= 0.0;
    const double at = distance / towards;
    if (towards < 0.0) {
      from = std::max(from, at);
    } else {
      to = std::min(to, at);
    }
    return from <= to;
  };
  if (!side(-dx, a.x() - area.left()) || !side(dx, area.right() - a.x()) ||
      !side(-dy, a.y() - area.top()) || !side(dy, area.bottom() - a.y())) {
    return std::nullopt;
  }
  // Points far outside leave no digits for where they cross.
  const auto held = [&](const QPointF& p) {
    return QPointF(std::clamp(p.x(), area.left(), area.right()),
                   std::clamp(p.y(), area.top(), area.bottom()));
  };
  return std::pair(held(a + from * (b - a)), held(a + to * (b - a)));
}

bool finite(const QPointF& point) {
  return std::isfinite(point.x()) && std::isfinite(point.y());
}

}  // namespace

std::vector<std::vector<QPointF>> clipped(const std::vector<QPointF>& line, const QRectF& area) {
  std::vector<std::vector<QPointF>> pieces;
  bool joined = false;  // the last piece goes on from line[i - 1]
  for (std::size_t i = 1; i < line.size(); ++i) {
    const auto part =
        finite(line[i - 1]) && finite(line[i]) ? cut(line[i - 1], line[i], area) : std::nullopt;
    if (!part) {
      joined = false;
      continue;
    }
    if (joined) {
      pieces.back().push_back(part->second);
    } else {
      pieces.push_back({part->first, part->second});
    }
    joined = part->second == line[i];
  }
  return pieces;
}

std::vector<QPointF> thinned(const std::vector<QPointF>& line) {
  std::vector<QPointF> kept;
  for (std::size_t first = 0, end = 0; first < line.size(); first = end) {
    const double column = std::floor(line[first].x());
    std::size_t low = first, high = first;
    for (end = first; end < line.size() && std::floor(line[end].x()) == column; ++end) {
      if (line[end].y() < line[low].y()) low = end;
      if (line[end].y() > line[high].y()) high = end;
    }
    std::array<std::size_t, 4> keep{first, low, high, end - 1};
    std::sort(keep.begin(), keep.end());
    const auto last = std::unique(keep.begin(), keep.end());
    for (auto i = keep.begin(); i != last; ++i) kept.push_back(line[*i]);
  }
  return kept;
}

}  // namespace trephine::plot
