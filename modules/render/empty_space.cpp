#include "render/empty_space.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <utility>

#include "render/dirty_boxes.h"
#include "volume/two_threads.h"

namespace trephine {

namespace {

constexpr int kFarthest = 255;
constexpr BrickRanges::Range kNothing{INT16_MAX, INT16_MIN};

// The ranges of the bricks [first, last) of row (j, k). Rows of voxels are folded together before
// they are cut into bricks, which a compiler turns into a few wide instructions.
void scanRow(const Volume& volume, int j, int k, int first, int last, BrickRanges::Range* out) {
  const Index3& n = volume.geometry.size;
  const auto low = [](int brick) { return std::max(0, brick * kLeapEdge - 1); };
  const auto high = [](int brick, int size) { return std::min(size, (brick + 1) * kLeapEdge + 1); };
  const int x0 = low(first), x1 = high(last - 1, n[0]);
  const auto width = std::size_t(x1 - x0);
  std::vector<std::int16_t> lowest(width, INT16_MAX), highest(width, INT16_MIN);
  for (int z = low(k), z1 = high(k, n[2]); z < z1; ++z) {
    for (int y = low(j), y1 = high(j, n[1]); y < y1; ++y) {
      const std::int16_t* row = volume.hu.data() + volume.geometry.indexOf(x0, y, z);
      for (std::size_t x = 0; x < width; ++x) {
        lowest[x] = std::min(lowest[x], row[x]);
        highest[x] = std::max(highest[x], row[x]);
      }
    }
  }
  for (int i = first; i < last; ++i) {
    BrickRanges::Range range = kNothing;
    for (int x = low(i), end = high(i, n[0]); x < end; ++x) {
      range.low = std::min(range.low, lowest[std::size_t(x - x0)]);
      range.high = std::max(range.high, highest[std::size_t(x - x0)]);
    }
    out[i - first] = range;
  }
}

template <class Visit>
void forEachBrick(const BrickBox& box, Visit visit) {
  for (int k = box.low[2]; k < box.high[2]; ++k) {
    for (int j = box.low[1]; j < box.high[1]; ++j) {
      for (int i = box.low[0]; i < box.high[0]; ++i) visit(i, j, k);
    }
  }
}

BrickBox grown(const BrickBox& box, int by, const Index3& size) {
  BrickBox result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.low[axis] = std::max(0, box.low[axis] - by);
    result.high[axis] = std::min(size[axis], box.high[axis] + by);
  }
  return result;
}

}  // namespace

BrickRanges::BrickRanges(const Volume& volume) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    size_[axis] = (volume.geometry.size[axis] + kLeapEdge - 1) / kLeapEdge;
  }
  ranges_.resize(std::size_t(size_[0]) * std::size_t(size_[1]) * std::size_t(size_[2]));
  onTwoThreads(size_[2], [&](int k) {
    for (int j = 0; j < size_[1]; ++j) {
      scanRow(volume, j, k, 0, size_[0], ranges_.data() + indexOf(0, j, k));
    }
  });
}

std::optional<BrickBox> BrickRanges::update(const Volume& volume, const VoxelBox& box) {
  if (voxelCount(box) == 0) return std::nullopt;
  BrickBox reach;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // A voxel counts in the brick beside it too when it lies at that brick's rim.
    reach.low[axis] = std::max(0, (box.low[axis] - 1) / kLeapEdge);
    reach.high[axis] = std::min(size_[axis], box.high[axis] / kLeapEdge + 1);
  }
  std::optional<BrickBox> changed;
  std::vector<Range> row(std::size_t(reach.high[0] - reach.low[0]));
  for (int k = reach.low[2]; k < reach.high[2]; ++k) {
    for (int j = reach.low[1]; j < reach.high[1]; ++j) {
      scanRow(volume, j, k, reach.low[0], reach.high[0], row.data());
      for (int i = reach.low[0]; i < reach.high[0]; ++i) {
        Range& kept = ranges_[indexOf(i, j, k)];
        const Range& now = row[std::size_t(i - reach.low[0])];
        if (kept == now) continue;
        kept = now;
        const BrickBox here{{i, j, k}, {i + 1, j + 1, k + 1}};
        changed = changed ? commonBox(*changed, here) : here;
      }
    }
  }
  return changed;
}

BrickRanges::Range BrickRanges::whole() const {
  Range whole = kNothing;
  for (const Range& range : ranges_) {
    whole.low = std::min(whole.low, range.low);
    whole.high = std::max(whole.high, range.high);
  }
  return whole;
}

BrickLabels::BrickLabels(const Index3& voxels) : voxels_(voxels) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    size_[axis] = (voxels[axis] + kLeapEdge - 1) / kLeapEdge;
  }
  labels_.resize(std::size_t(size_[0]) * std::size_t(size_[1]) * std::size_t(size_[2]),
                 Labels{1, 0, 0, 0});
}

void BrickLabels::update(const LabelMap& labels, const VoxelBox& box) {
  BrickBox reach;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    reach.low[axis] = box.low[axis] / kLeapEdge;
    reach.high[axis] = std::min(size_[axis], (box.high[axis] + kLeapEdge - 1) / kLeapEdge);
  }
  forEachBrick(reach, [&](int i, int j, int k) {
    Labels& of =
        labels_[(std::size_t(k) * std::size_t(size_[1]) + std::size_t(j)) * std::size_t(size_[0]) +
                std::size_t(i)];
    of = {};
    const int i0 = i * kLeapEdge, i1 = std::min(voxels_[0], i0 + kLeapEdge);
    int last = -1;
    for (int z = k * kLeapEdge, z1 = std::min(voxels_[2], z + kLeapEdge); z < z1; ++z) {
      for (int y = j * kLeapEdge, y1 = std::min(voxels_[1], y + kLeapEdge); y < y1; ++y) {
        const std::uint8_t* label = labels.labels.data() + labels.geometry.indexOf(i0, y, z);
        for (int x = i0; x < i1; ++x, ++label) {
          if (*label == last) continue;
          last = *label;
          of[std::size_t(last) / 64] |= std::uint64_t(1) << (last % 64);
        }
      }
    }
  });
}

std::uint32_t BrickLabels::rowsOf(std::size_t brick, const LabelRows& rows) const {
  static_assert(LabelRows::kMost <= 32);
  std::uint32_t bits = 0;
  for (std::size_t word = 0; word < 4; ++word) {
    for (std::uint64_t left = labels_[brick][word]; left != 0; left &= left - 1) {
      bits |= 1u << rows.row[word * 64 + std::size_t(std::countr_zero(left))];
    }
  }
  return bits;
}

std::vector<std::uint32_t> BrickLabels::rows(const LabelRows& rows) const {
  std::vector<std::uint32_t> bits(labels_.size());
  for (std::size_t brick = 0; brick < bits.size(); ++brick) bits[brick] = rowsOf(brick, rows);
  return bits;
}

bool EmptySpaceDistance::visible(const BrickRanges& bricks, std::size_t brick) const {
  const BrickRanges::Range range = bricks.ranges()[brick];
  const std::uint32_t rows = rows_.empty() ? 1u : rows_[brick];
  for (std::size_t row = 0; row < visible_.size(); ++row) {
    if (!(rows >> row & 1u)) continue;
    for (const HuInterval& interval : visible_[row]) {
      if (range.high >= interval.low && range.low <= interval.high) return true;
    }
  }
  return false;
}

// Chessboard distance in two sweeps, each from the 13 neighbours already visited (Rosenfeld and
// Pfaltz, Sequential operations in digital picture processing, J. ACM 13, 1966).
EmptySpaceDistance::EmptySpaceDistance(const BrickRanges& bricks, std::vector<HuInterval> visible,
                                       double margin_HU)
    : EmptySpaceDistance(bricks, std::vector<std::vector<HuInterval>>{std::move(visible)}, {},
                         margin_HU) {}

EmptySpaceDistance::EmptySpaceDistance(const BrickRanges& bricks,
                                       std::vector<std::vector<HuInterval>> visible_by_row,
                                       std::vector<std::uint32_t> rows, double margin_HU)
    : visible_(std::move(visible_by_row)),
      rows_(std::move(rows)),
      distances_(bricks.ranges().size(), kFarthest) {
  for (std::vector<HuInterval>& intervals : visible_) {
    for (HuInterval& interval : intervals) {
      interval.low -= margin_HU;
      interval.high += margin_HU;
    }
  }
  const Index3& n = bricks.size();
  for (std::size_t b = 0; b < distances_.size(); ++b) {
    if (visible(bricks, b)) distances_[b] = 0;
  }
  const auto sweep = [&](int sign) {
    const auto order = [&](int size, int step) { return sign > 0 ? step : size - 1 - step; };
    forEachBrick({{0, 0, 0}, n}, [&](int ii, int jj, int kk) {
      const int i = order(n[0], ii), j = order(n[1], jj), k = order(n[2], kk);
      std::uint8_t& here = distances_[bricks.indexOf(i, j, k)];
      if (here == 0) return;
      int nearest = here;
      const auto look = [&](int di, int dj, int dk) {
        const int x = i - sign * di, y = j - sign * dj, z = k - sign * dk;
        if (x < 0 || y < 0 || z < 0 || x >= n[0] || y >= n[1] || z >= n[2]) return;
        nearest = std::min(nearest, distances_[bricks.indexOf(x, y, z)] + 1);
      };
      look(1, 0, 0);
      for (int di = -1; di <= 1; ++di) look(di, 1, 0);
      for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di) look(di, dj, 1);
      }
      here = std::uint8_t(nearest);
    });
  };
  sweep(+1);
  sweep(-1);
}

void EmptySpaceDistance::update(const BrickRanges& bricks, const BrickBox& changed) {
  const Index3& n = bricks.size();
  // Neighbours never differ by more than one, here and in what follows; so where a ring around a
  // brick that became visible holds nothing too far, no ring beyond it does.
  forEachBrick(changed, [&](int i, int j, int k) {
    std::uint8_t& here = distances_[bricks.indexOf(i, j, k)];
    if (here == 0 || !visible(bricks, bricks.indexOf(i, j, k))) return;
    here = 0;
    bool shortened = true;
    for (int ring = 1; shortened && ring < kFarthest; ++ring) {
      shortened = false;
      const BrickBox self{{i, j, k}, {i + 1, j + 1, k + 1}};
      forEachBrick(grown(self, ring, n), [&](int x, int y, int z) {
        if (std::max({std::abs(x - i), std::abs(y - j), std::abs(z - k)}) != ring) return;
        std::uint8_t& there = distances_[bricks.indexOf(x, y, z)];
        if (there <= ring) return;
        there = std::uint8_t(ring);
        shortened = true;
      });
    }
  });
  // A brick without matter is one farther than its nearest neighbour. A few rounds reach the middle
  // of what one cut empties; what they miss is leapt over in smaller steps.
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    forEachBrick(grown(changed, kRounds, n), [&](int i, int j, int k) {
      const std::size_t index = bricks.indexOf(i, j, k);
      if (distances_[index] == 0 && visible(bricks, index)) return;
      int nearest = kFarthest - 1;
      forEachBrick(grown({{i, j, k}, {i + 1, j + 1, k + 1}}, 1, n), [&](int x, int y, int z) {
        if (x == i && y == j && z == k) return;
        nearest = std::min(nearest, int(distances_[bricks.indexOf(x, y, z)]));
      });
      distances_[index] = std::uint8_t(std::max(int(distances_[index]), nearest + 1));
    });
  }
}

}  // namespace trephine
