// What the knobs share: a core on one arm without a bound, run along prescribed poses.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "haptics/haptic_core.h"

namespace trephine {

constexpr double kTradePeriod_s = 1e-3;  // of the knobs that are not the rate

// One class from `hu_min` up, that of the exercises' bone: 12 N s/m, 900 N/m, 2 N.
TissueTable tradeTissue(int hu_min, bool cuttable, double cutting_J_per_mm3);

// One Omni, `off`, patient and device axes alike.
HapticParameters tradeParameters(const Tool& tool, const TissueTable& tissues,
                                 const std::vector<LawKind>& laws, ForceAt force_at,
                                 double period_s);

struct StrokeRun {
  std::vector<Vec3> demanded_N;
  std::vector<std::size_t> removed;      // voxels
  std::vector<std::int16_t> removed_hu;  // of each of them, before
  double tick_ns = 0.0;                  // median
};

// `ticks` ticks; nothing where it was cancelled. The grid is left as the stroke left it. Without
// `removes` the core takes nothing and looks for nothing to take.
std::optional<StrokeRun> runStroke(const HapticParameters& parameters, Grid& grid,
                                   std::size_t ticks,
                                   const std::function<Pose(double t_s)>& pose_mm, bool removes,
                                   const Progress& progress);

// Puts back what a stroke took.
void putBack(Grid& grid, const StrokeRun& run);

// RMS |a - b| over RMS |b|, in percent; 0 where b is nothing and a is too, else 100.
double rmsError_percent(const std::vector<Vec3>& a, const std::vector<Vec3>& b);

}  // namespace trephine
