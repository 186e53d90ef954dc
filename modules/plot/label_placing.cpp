#include "plot/label_placing.h"

#include <algorithm>
#include <limits>

namespace trephine::plot {

namespace {

double areaOf(const QRectF& rect) {
  return rect.isEmpty() ? 0.0 : rect.width() * rect.height();
}

}  // namespace

QRectF placed(const std::vector<QRectF>& candidates, const std::vector<QRectF>& taken,
              const QRectF& area) {
  QRectF best;
  double least = std::numeric_limits<double>::infinity();
  for (const QRectF& candidate : candidates) {
    double covered = areaOf(candidate) - areaOf(candidate.intersected(area));
    for (const QRectF& other : taken) covered += areaOf(candidate.intersected(other));
    if (covered >= least) continue;
    least = covered;
    best = candidate;
    if (covered <= 0.0) break;
  }
  return best;
}

std::vector<QRectF> around(const QPointF& centre, double radius, const QSizeF& size) {
  std::vector<QRectF> candidates;
  for (const double further : {0.0, 12.0, 26.0, 42.0, 60.0, 80.0}) {
    const double d = radius + 3.0 + further;
    const double right = centre.x() + 0.8 * d, left = centre.x() - 0.8 * d - size.width();
    const double above = centre.y() - 0.8 * d - size.height(), below = centre.y() + 0.8 * d;
    const double middle_x = centre.x() - 0.5 * size.width();
    const double middle_y = centre.y() - 0.5 * size.height();
    for (const QPointF& corner :
         {QPointF(right, above), QPointF(left, above), QPointF(right, below), QPointF(left, below),
          QPointF(centre.x() + d, middle_y), QPointF(centre.x() - d - size.width(), middle_y),
          QPointF(middle_x, centre.y() - d - size.height()), QPointF(middle_x, centre.y() + d)}) {
      candidates.push_back({corner, size});
    }
  }
  return candidates;
}

void spread(std::vector<double>& at, double apart, double high) {
  for (std::size_t i = 1; i < at.size(); ++i) at[i] = std::max(at[i], at[i - 1] + apart);
  for (std::size_t i = at.size(); i-- > 0; high = at[i] - apart) at[i] = std::min(at[i], high);
}

}  // namespace trephine::plot
