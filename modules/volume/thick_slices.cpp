#include "volume/thick_slices.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "base/codes.h"
#include "base/tr.h"
#include "volume/two_threads.h"

namespace trephine {

namespace {

constexpr double kWanted_mm = 1.0;
constexpr double kThickerThanPixels = 1.5;

// Between a and b, `part` of `steps` on the way; halves away from zero.
std::int16_t between(std::int32_t a, std::int32_t b, std::int32_t part, std::int32_t steps) {
  const std::int32_t sum = a * (steps - part) + b * part;
  return std::int16_t((sum >= 0 ? sum + steps / 2 : sum - steps / 2) / steps);
}

}  // namespace

int stepsBetweenSlices(const GridGeometry& geometry) {
  const Vec3& s = geometry.spacing_mm;
  const double pixel_mm = std::max(s.x, s.y);
  if (geometry.size[2] < 2 || !(s.z > kThickSlices_mm) || !(s.z > kThickerThanPixels * pixel_mm)) {
    return 1;
  }
  return int(std::ceil(s.z / std::max(kWanted_mm, pixel_mm) - 1e-6));
}

GridGeometry withThinSlices(GridGeometry geometry, int steps) {
  if (steps < 2 || geometry.size[2] < 2) return geometry;
  geometry.size[2] = (geometry.size[2] - 1) * steps + 1;
  geometry.spacing_mm.z /= double(steps);
  return geometry;
}

Result<Volume> withThinSlices(const Volume& volume, int steps) {
  const GridGeometry grid = withThinSlices(volume.geometry, steps);
  if (const Status status = checkSize(grid.size, "slices"); !status.ok()) return status.error();
  try {
    Volume thin{grid, {}};
    thin.hu.resize(grid.voxelCount());
    const std::size_t in_slice = std::size_t(grid.size[0]) * std::size_t(grid.size[1]);
    const int slices = grid.size[2];
    onTwoThreads(2, [&](int half) {
      for (int k = half * slices / 2; k < (half + 1) * slices / 2; ++k) {
        const int part = k % steps;
        const std::int16_t* low = volume.hu.data() + std::size_t(k / steps) * in_slice;
        const std::int16_t* high = part == 0 ? low : low + in_slice;
        std::int16_t* to = thin.hu.data() + std::size_t(k) * in_slice;
        for (std::size_t n = 0; n < in_slice; ++n) to[n] = between(low[n], high[n], part, steps);
      }
    });
    return thin;
  } catch (const std::bad_alloc&) {
    return Error{code::kOutOfMemory, tr("There is not enough memory for slices between the slices"),
                 "slices", tr("Close other programs, or crop the scan")};
  }
}

}  // namespace trephine
