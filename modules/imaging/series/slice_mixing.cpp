#include "imaging/series/detail/slice_mixing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "imaging/common/detail/stored_values.h"

namespace trephine {

namespace {

// Where along one axis a target lies between two source voxels.
struct Between {
  int lower;
  double upper_share;  // 0: on the lower one
};

Between between(int target, double shift) {
  const double at = target - shift;
  const double nearest = std::round(at);
  if (std::abs(at - nearest) < 1e-3) return {int(nearest), 0.0};
  const double lower = std::floor(at);
  return {int(lower), at - lower};
}

}  // namespace

void shiftSlice(const std::int16_t* source, SliceSize source_size, std::array<double, 2> shift,
                std::int16_t* target, SliceSize target_size) {
  const auto sample = [&](int i, int j) {
    const bool inside = i >= 0 && j >= 0 && i < source_size.columns && j < source_size.rows;
    return inside ? source[std::size_t(j) * std::size_t(source_size.columns) + std::size_t(i)]
                  : kLostHu;
  };
  if (shift[0] == 0.0 && shift[1] == 0.0 && target_size.columns == source_size.columns &&
      target_size.rows == source_size.rows) {
    std::copy_n(source, std::size_t(source_size.columns) * std::size_t(source_size.rows), target);
    return;
  }
  for (int j = 0; j < target_size.rows; ++j) {
    const Between row = between(j, shift[1]);
    std::int16_t* line = target + std::size_t(j) * std::size_t(target_size.columns);
    for (int i = 0; i < target_size.columns; ++i) {
      const Between column = between(i, shift[0]);
      const double x = column.upper_share, y = row.upper_share;
      const std::int16_t hu[4] = {
          sample(column.lower, row.lower), x > 0.0 ? sample(column.lower + 1, row.lower) : kLostHu,
          y > 0.0 ? sample(column.lower, row.lower + 1) : kLostHu,
          x > 0.0 && y > 0.0 ? sample(column.lower + 1, row.lower + 1) : kLostHu};
      const double weights[4] = {(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y};
      double sum = 0.0, weight = 0.0;
      for (int n = 0; n < 4; ++n) {
        if (hu[n] == kLostHu) continue;
        sum += weights[n] * hu[n];
        weight += weights[n];
      }
      const int nearest = (x >= 0.5 ? 1 : 0) + (y >= 0.5 ? 2 : 0);
      line[i] = hu[nearest] == kLostHu ? kLostHu : std::int16_t(std::lrint(sum / weight));
    }
  }
}

void mixSlices(const std::int16_t* lower, const std::int16_t* upper, double upper_share,
               std::size_t count, std::int16_t* target) {
  for (std::size_t n = 0; n < count; ++n) {
    if (lower[n] == kLostHu || upper[n] == kLostHu) {
      target[n] = upper_share < 0.5 ? lower[n] : upper[n];
    } else {
      target[n] = std::int16_t(std::lrint((1.0 - upper_share) * lower[n] + upper_share * upper[n]));
    }
  }
}

}  // namespace trephine
