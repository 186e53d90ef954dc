#include "render/label_shape.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace trephine {

LabelShapes::LabelShapes(const LabelMap& labels, const VoxelBox& box)
    : labels_(labels),
      box_(box),
      k_(box.low[2]),
      width_(std::size_t(box.high[0] - box.low[0])),
      height_(std::size_t(box.high[1] - box.low[1])) {
  marks_.resize((width_ + 2) * (height_ + 2));
  across_.resize(width_ * (height_ + 2));
  most_.resize(width_ * (height_ + 2));
  shapes_.resize(width_ * height_);
  for (Plane& plane : planes_) {
    plane.folded.resize(width_ * height_);
    plane.highest.resize(width_ * height_);
  }
  for (int k = k_ - 1; k <= k_ + 1; ++k) addSlice(k);
}

// Becomes the last of the three; outside of the map there is no label.
void LabelShapes::addSlice(int k) {
  std::swap(planes_[0], planes_[1]);
  std::swap(planes_[1], planes_[2]);
  Plane& plane = planes_[2];
  plane.any = false;
  const Index3& n = labels_.geometry.size;
  if (k < 0 || k >= n[2]) return;
  const std::size_t wide = width_ + 2;
  const int low = std::max(box_.low[0] - 1, 0), high = std::min(box_.high[0] + 1, n[0]);
  std::uint8_t any = 0;
  for (std::size_t row = 0; row < height_ + 2; ++row) {
    const int j = box_.low[1] - 1 + int(row);
    std::uint8_t* marks = marks_.data() + row * wide;
    std::memset(marks, 0, wide);
    if (j < 0 || j >= n[1]) continue;
    const std::uint8_t* from = labels_.labels.data() + labels_.geometry.indexOf(low, j, k);
    std::uint8_t* to = marks + (low - (box_.low[0] - 1));
    const auto count = std::size_t(high - low);
    std::memcpy(to, from, count);
    for (std::size_t i = 0; i < count; ++i) any |= to[i];
  }
  if (any == 0) return;
  plane.any = true;
  for (std::size_t row = 0; row < height_ + 2; ++row) {
    const std::uint8_t* m = marks_.data() + row * wide;
    std::uint8_t *sum = across_.data() + row * width_, *most = most_.data() + row * width_;
    for (std::size_t i = 0; i < width_; ++i) {
      sum[i] = std::uint8_t((m[i] != 0) + 2 * (m[i + 1] != 0) + (m[i + 2] != 0));
      most[i] = std::max(std::max(m[i], m[i + 1]), m[i + 2]);
    }
  }
  for (std::size_t v = 0; v < width_ * height_; ++v) {  // rows follow each other
    const std::uint8_t *sum = across_.data() + v, *most = most_.data() + v;
    plane.folded[v] = std::uint8_t(sum[0] + 2 * sum[width_] + sum[2 * width_]);
    plane.highest[v] = std::max(std::max(most[0], most[width_]), most[2 * width_]);
  }
}

const std::vector<LabelShape>& LabelShapes::next() {
  if (!planes_[0].any && !planes_[1].any && !planes_[2].any) {
    std::ranges::fill(shapes_, LabelShape{0, 0});
  } else {
    for (Plane& plane : planes_) {
      if (plane.any) continue;
      std::ranges::fill(plane.folded, std::uint8_t(0));
      std::ranges::fill(plane.highest, std::uint8_t(0));
    }
    const auto& [below, here, above] = planes_;
    for (std::size_t j = 0, v = 0; j < height_; ++j) {
      const std::uint8_t* own =
          labels_.labels.data() + labels_.geometry.indexOf(box_.low[0], box_.low[1] + int(j), k_);
      for (std::size_t i = 0; i < width_; ++i, ++v) {
        const int of_64 = below.folded[v] + 2 * here.folded[v] + above.folded[v];
        const int inside = of_64 * 255 / 64;
        const std::uint8_t nearest =
            std::max(std::max(below.highest[v], here.highest[v]), above.highest[v]);
        shapes_[v].label = own[i] ? own[i] : nearest;
        shapes_[v].inside = std::uint8_t(own[i] ? std::max(inside, 128) : std::min(inside, 127));
      }
    }
  }
  ++k_;
  if (!done()) addSlice(k_ + 1);
  return shapes_;
}

}  // namespace trephine
