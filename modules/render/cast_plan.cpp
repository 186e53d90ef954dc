#include "render/cast_plan.h"

#include <algorithm>

namespace trephine {

namespace {

// Each strip costs a millisecond or two beside its rays.
constexpr int kFewestRows = 8, kFewestColumns = 64;

}  // namespace

PixelRect bounding(const PixelRect& a, const PixelRect& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.low_x, b.low_x), std::min(a.low_y, b.low_y), std::max(a.high_x, b.high_x),
          std::max(a.high_y, b.high_y)};
}

void CastPlan::setWhole(int width, int height) {
  setNone(width, height);
  add({0, 0, width, height});
}

void CastPlan::setNone(int width, int height) {
  width_ = width;
  height_ = height;
  rects_.clear();
}

void CastPlan::add(PixelRect rect) {
  rect = {std::max(rect.low_x, 0), std::max(rect.low_y, 0), std::min(rect.high_x, width_),
          std::min(rect.high_y, height_)};
  if (rect.empty()) return;
  // Joined where that costs no more rays than both; a joined one may meet others.
  for (auto other = rects_.begin(); other != rects_.end();) {
    const PixelRect both = bounding(rect, *other);
    if (both.pixels() <= rect.pixels() + other->pixels()) {
      rect = both;
      rects_.erase(other);
      other = rects_.begin();
    } else {
      ++other;
    }
  }
  rects_.push_back(rect);
}

std::optional<PixelRect> CastPlan::next(double pixels) {
  if (rects_.empty()) return std::nullopt;
  const PixelRect rect = rects_.front();
  rects_.erase(rects_.begin());
  PixelRect strip = rect;
  const double rows = std::max(double(kFewestRows), pixels / rect.width());
  if (rows < rect.height()) strip.low_y = rect.high_y - int(rows);
  const double columns = std::max(double(kFewestColumns), pixels / strip.height());
  if (columns < rect.width()) strip.high_x = rect.low_x + int(columns);
  // What is left: beside it, then below it.
  const PixelRect below{rect.low_x, rect.low_y, rect.high_x, strip.low_y};
  const PixelRect beside{strip.high_x, strip.low_y, rect.high_x, rect.high_y};
  if (!below.empty()) rects_.insert(rects_.begin(), below);
  if (!beside.empty()) rects_.insert(rects_.begin(), beside);
  return strip;
}

double CastPlan::pixels() const {
  double sum = 0.0;
  for (const PixelRect& rect : rects_) sum += rect.pixels();
  return sum;
}

}  // namespace trephine
