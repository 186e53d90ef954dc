// Which pixels of a picture have no ray yet, handed out in strips. Pure.
#pragma once

#include <optional>
#include <vector>

namespace trephine {

// Pixels from low to high, the latter not included; rows go up.
struct PixelRect {
  int low_x = 0;
  int low_y = 0;
  int high_x = 0;
  int high_y = 0;

  int width() const { return high_x - low_x; }
  int height() const { return high_y - low_y; }
  bool empty() const { return width() <= 0 || height() <= 0; }
  double pixels() const { return empty() ? 0.0 : double(width()) * double(height()); }
  friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

PixelRect bounding(const PixelRect& a, const PixelRect& b);

class CastPlan {
 public:
  // All pixels of a picture of this size, or none.
  void setWhole(int width, int height);
  void setNone(int width, int height);
  // These too; what lies outside of the picture is left out. Those that overlap are cast once.
  void add(PixelRect rect);
  // The next strip, from the top, of at most so many pixels, but at least a small block.
  std::optional<PixelRect> next(double pixels);

  bool done() const { return rects_.empty(); }
  const std::vector<PixelRect>& left() const { return rects_; }
  double pixels() const;  // left

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<PixelRect> rects_;
};

}  // namespace trephine
