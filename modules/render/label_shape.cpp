#include "render/label_shape.h"

#include <algorithm>
#include <utility>

namespace trephine {

LabelShapes::LabelShapes(const LabelMap& labels, const LabelRows& rows)
    : labels_(labels), rows_(rows) {
  const std::size_t slice =
      std::size_t(labels.geometry.size[0]) * std::size_t(labels.geometry.size[1]);
  marks_.resize(slice);
  shapes_.resize(slice);
  for (int n = 0; n < 3; ++n) {
    folded_[n].assign(slice, 0);
    neighbour_[n].assign(slice, 0);
  }
  addSlice(0);
  addSlice(1);
}

// Becomes the last of the three; outside of the map there is no label.
void LabelShapes::addSlice(int k) {
  std::swap(folded_[0], folded_[1]);
  std::swap(folded_[1], folded_[2]);
  std::swap(neighbour_[0], neighbour_[1]);
  std::swap(neighbour_[1], neighbour_[2]);
  std::vector<std::uint8_t>&sum = folded_[2], &largest = neighbour_[2];
  std::ranges::fill(sum, std::uint8_t(0));
  std::ranges::fill(largest, std::uint8_t(0));
  const Index3& n = labels_.geometry.size;
  if (k >= n[2]) return;
  const auto width = std::size_t(n[0]);
  const std::uint8_t* label = labels_.labels.data() + std::size_t(k) * marks_.size();
  std::transform(label, label + marks_.size(), marks_.begin(),
                 [&](std::uint8_t l) { return rows_.row[l]; });
  for (int j = 0; j < n[1]; ++j) {
    for (int dj = -1; dj <= 1; ++dj) {
      if (j + dj < 0 || j + dj >= n[1]) continue;
      const std::uint8_t* from = marks_.data() + std::size_t(j + dj) * width;
      std::uint8_t* to = sum.data() + std::size_t(j) * width;
      std::uint8_t* most = largest.data() + std::size_t(j) * width;
      const int weight = 2 - std::abs(dj);
      for (std::size_t i = 0; i < width; ++i) {
        const std::uint8_t left = i > 0 ? from[i - 1] : 0, right = i + 1 < width ? from[i + 1] : 0;
        to[i] = std::uint8_t(to[i] + weight * ((left != 0) + 2 * (from[i] != 0) + (right != 0)));
        most[i] = std::max({most[i], left, from[i], right});
      }
    }
  }
}

const std::vector<LabelShape>& LabelShapes::next() {
  const std::uint8_t* label = labels_.labels.data() + std::size_t(k_) * shapes_.size();
  for (std::size_t v = 0; v < shapes_.size(); ++v) {
    const int of_64 = folded_[0][v] + 2 * folded_[1][v] + folded_[2][v];
    const int inside = of_64 * 255 / 64;
    const std::uint8_t own = rows_.row[label[v]];
    shapes_[v].row = own ? own : std::max({neighbour_[0][v], neighbour_[1][v], neighbour_[2][v]});
    shapes_[v].inside = std::uint8_t(own ? std::max(inside, 128) : std::min(inside, 127));
  }
  ++k_;
  addSlice(k_ + 1);
  return shapes_;
}

}  // namespace trephine
