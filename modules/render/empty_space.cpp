#include "render/empty_space.h"

#include <algorithm>

namespace trephine {

namespace {

std::size_t brickIndex(const Index3& size, int i, int j, int k) {
  return (std::size_t(k) * std::size_t(size[1]) + std::size_t(j)) * std::size_t(size[0]) +
         std::size_t(i);
}

BrickRanges::Range rangeOf(const Volume& volume, int i, int j, int k) {
  const Index3& n = volume.geometry.size;
  const auto low = [](int b) { return std::max(0, b * kLeapEdge - 1); };
  const auto high = [](int b, int size) { return std::min(size, (b + 1) * kLeapEdge + 1); };
  BrickRanges::Range range{INT16_MAX, INT16_MIN};
  const int x0 = low(i), x1 = high(i, n[0]);
  for (int z = low(k), z1 = high(k, n[2]); z < z1; ++z) {
    for (int y = low(j), y1 = high(j, n[1]); y < y1; ++y) {
      const std::int16_t* row = volume.hu.data() + volume.geometry.indexOf(0, y, z);
      for (int x = x0; x < x1; ++x) {
        range.low = std::min(range.low, row[x]);
        range.high = std::max(range.high, row[x]);
      }
    }
  }
  return range;
}

}  // namespace

BrickRanges::BrickRanges(const Volume& volume) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    size_[axis] = (volume.geometry.size[axis] + kLeapEdge - 1) / kLeapEdge;
  }
  ranges_.resize(std::size_t(size_[0]) * std::size_t(size_[1]) * std::size_t(size_[2]));
  std::size_t index = 0;
  for (int k = 0; k < size_[2]; ++k) {
    for (int j = 0; j < size_[1]; ++j) {
      for (int i = 0; i < size_[0]; ++i) ranges_[index++] = rangeOf(volume, i, j, k);
    }
  }
}

bool BrickRanges::update(const Volume& volume, const VoxelBox& box) {
  Index3 low, high;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // A voxel counts in the brick beside it when it lies on that brick's rim.
    low[axis] = std::max(0, (box.low[axis] - 1) / kLeapEdge);
    high[axis] = std::min(size_[axis], box.high[axis] / kLeapEdge + 1);
  }
  bool changed = false;
  for (int k = low[2]; k < high[2]; ++k) {
    for (int j = low[1]; j < high[1]; ++j) {
      for (int i = low[0]; i < high[0]; ++i) {
        const Range range = rangeOf(volume, i, j, k);
        Range& kept = ranges_[brickIndex(size_, i, j, k)];
        changed = changed || !(range == kept);
        kept = range;
      }
    }
  }
  return changed;
}

BrickRanges::Range BrickRanges::whole() const {
  Range whole{INT16_MAX, INT16_MIN};
  for (const Range& range : ranges_) {
    whole.low = std::min(whole.low, range.low);
    whole.high = std::max(whole.high, range.high);
  }
  return whole;
}

std::vector<std::uint8_t> leapDistances(const BrickRanges& bricks,
                                        const std::vector<HuInterval>& visible, double margin_HU) {
  const Index3& n = bricks.size();
  std::vector<std::uint8_t> distance(bricks.ranges().size(), 255);
  for (std::size_t b = 0; b < distance.size(); ++b) {
    const BrickRanges::Range& range = bricks.ranges()[b];
    const bool met = std::any_of(visible.begin(), visible.end(), [&](const HuInterval& v) {
      return range.high >= v.low - margin_HU && range.low <= v.high + margin_HU;
    });
    if (met) distance[b] = 0;
  }
  // Chessboard distance in two sweeps, each from the 13 neighbours already visited (Rosenfeld and
  // Pfaltz, Sequential operations in digital picture processing, J. ACM 13, 1966).
  const auto sweep = [&](int sign) {
    const auto order = [&](int size, int step) { return sign > 0 ? step : size - 1 - step; };
    for (int kk = 0; kk < n[2]; ++kk) {
      for (int jj = 0; jj < n[1]; ++jj) {
        for (int ii = 0; ii < n[0]; ++ii) {
          const int i = order(n[0], ii), j = order(n[1], jj), k = order(n[2], kk);
          std::uint8_t& here = distance[brickIndex(n, i, j, k)];
          if (here == 0) continue;
          int nearest = here;
          const auto look = [&](int di, int dj, int dk) {
            const int x = i - sign * di, y = j - sign * dj, z = k - sign * dk;
            if (x < 0 || y < 0 || z < 0 || x >= n[0] || y >= n[1] || z >= n[2]) return;
            nearest = std::min(nearest, distance[brickIndex(n, x, y, z)] + 1);
          };
          look(1, 0, 0);
          for (int di = -1; di <= 1; ++di) look(di, 1, 0);
          for (int dj = -1; dj <= 1; ++dj) {
            for (int di = -1; di <= 1; ++di) look(di, dj, 1);
          }
          here = std::uint8_t(nearest);
        }
      }
    }
  };
  sweep(+1);
  sweep(-1);
  return distance;
}

}  // namespace trephine
