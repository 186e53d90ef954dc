// How true is the push of elastic tissue? A burr's ball slides over a surface that is known
// exactly.
#pragma once

#include <vector>

#include "base/math.h"
#include "base/progress.h"
#include "base/result.h"

namespace trephine {

struct SlidingOptions {
  int grid = 256;        // voxels along each edge of a box of 200 mm
  int paths = 10;        // great ellipses over the shell
  double seconds = 2.0;  // each
  double noise_hu = 10.0;
};

struct SlidingMeasurement {
  double direction_median_deg = 0.0, direction_p99_deg = 0.0;  // between force and true normal
  double step_p99_percent = 0.0;                               // |F(n) - F(n-1)| of the mean |F|
  double depth_error_percent = 0.0;  // of mean |F| against stiffness times depth
  std::size_t ticks = 0;
};

// One tick of a slide: the force, and the surface's true normal.
struct SlidingTick {
  Vec3 force_N{0.0};
  Vec3 normal{0.0, 0.0, 1.0};
};
// Each path of at least one tick on its own; steps are taken within a path. A force of nothing is
// 180 degrees off. `true_N` is what |F| should be.
SlidingMeasurement judgeSliding(const std::vector<std::vector<SlidingTick>>& paths, double true_N);

// A burr of 1.5 mm radius, its surface 0.5 mm deep in bone of 500 N/m, at 30 mm/s and 1 kHz, over
// the outer surface of a scanned shell; the force is the core's demanded one, elastic law alone.
// Errors: BAD_ARGUMENT, CANCELLED.
Result<SlidingMeasurement> measureSliding(const SlidingOptions& options, const Progress& progress,
                                          double from = 0.0, double to = 1.0);

}  // namespace trephine
