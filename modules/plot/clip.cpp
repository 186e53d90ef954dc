#include "plot/clip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
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
  return std::pair(a + from * (b - a), a + to * (b - a));
}

// Far enough outside for a slope to stay what it is, near enough to leave digits for where it
// crosses an edge: a ten thousandth of a pixel.
QPointF held(const QPointF& point) {
  constexpr double kFar = 1e12;
  return {std::clamp(point.x(), -kFar, kFar), std::clamp(point.y(), -kFar, kFar)};
}

bool finite(const QPointF& point) {
  return std::isfinite(point.x()) && std::isfinite(point.y());
}

}  // namespace

std::vector<std::vector<QPointF>> clipped(const std::vector<QPointF>& line, const QRectF& area) {
  std::vector<std::vector<QPointF>> pieces;
  bool joined = false;  // the last piece goes on from line[i - 1]
  const auto gap = [&](std::size_t i) { return i >= line.size() || !finite(line[i]); };
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (i == 0 || gap(i - 1)) {
      joined = false;
      if (!gap(i) && gap(i + 1) && area.contains(line[i])) pieces.push_back({line[i]});
      continue;
    }
    const auto part = gap(i) ? std::nullopt : cut(held(line[i - 1]), held(line[i]), area);
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

std::vector<std::vector<QPointF>> dashed(const std::vector<QPointF>& line,
                                         const std::vector<double>& dashes) {
  std::vector<std::vector<QPointF>> pieces;
  std::size_t dash = 0;
  double left = dashes[0];  // of this dash
  bool joined = false;      // the last piece goes on
  for (std::size_t i = 1; i < line.size(); ++i) {
    const QPointF way = line[i] - line[i - 1];
    const double length = std::hypot(way.x(), way.y());
    for (double from = 0.0; from < length;) {
      const bool ends = from + left <= length;
      const double to = ends ? from + left : length;
      if (dash % 2 == 0) {
        if (!joined) pieces.push_back({line[i - 1] + way * (from / length)});
        pieces.back().push_back(line[i - 1] + way * (to / length));
      }
      joined = !ends && dash % 2 == 0;
      left -= to - from;
      if (ends) {
        dash = (dash + 1) % dashes.size();
        left = dashes[dash];
      }
      from = to;
    }
  }
  return pieces;
}

// Sutherland and Hodgman 1974: cut at one edge after the other.
std::vector<QPointF> clippedArea(std::vector<QPointF> outline, const QRectF& area) {
  std::transform(outline.begin(), outline.end(), outline.begin(), held);
  struct Edge {
    QPointF outwards;
    double at;
  };
  for (const Edge& edge : {Edge{{-1.0, 0.0}, -area.left()}, Edge{{1.0, 0.0}, area.right()},
                           Edge{{0.0, -1.0}, -area.top()}, Edge{{0.0, 1.0}, area.bottom()}}) {
    std::vector<QPointF> kept;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const QPointF &a = outline[i], &b = outline[(i + 1) % outline.size()];
      const double within_a = edge.at - QPointF::dotProduct(edge.outwards, a);
      const double within_b = edge.at - QPointF::dotProduct(edge.outwards, b);
      if (within_a >= 0.0) kept.push_back(a);
      if ((within_a >= 0.0) != (within_b >= 0.0)) {
        kept.push_back(a + (b - a) * (within_a / (within_a - within_b)));
      }
    }
    outline = std::move(kept);
  }
  return outline;
}

}  // namespace trephine::plot
