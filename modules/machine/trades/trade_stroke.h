// What the knobs share: a core on one arm without a bound, run along prescribed poses.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <string>
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
  double tick_ns = 0.0;                  // mean
};

// `ticks` ticks; nothing where it was cancelled. The grid is left as the stroke left it. Without
// `removes` the core takes nothing and looks for nothing to take.
std::optional<StrokeRun> runStroke(const HapticParameters& parameters, Grid& grid,
                                   std::size_t ticks,
                                   const std::function<Pose(double t_s)>& pose_mm, bool removes,
                                   const Progress& progress);

// Puts back what a stroke took.
void putBack(Grid& grid, const StrokeRun& run);

// What a stroke varies in, drawn at random: the same in every build.
class StrokeDice {
 public:
  explicit StrokeDice(int stroke) : random_(std::uint32_t(stroke) + 1) {}
  double between(double low, double high) {
    return low + (high - low) * double(random_()) / 4294967296.0;
  }
  // A heading all around, in the plane z = 0.
  Vec3 heading() {
    const double angle = between(0.0, 6.283185307179586);
    return {std::cos(angle), std::sin(angle), 0.0};
  }

 private:
  std::mt19937 random_;
};

// What a setting gets wrong over several strokes. It is stated by the 90th percentile, so that it
// holds for most strokes that are not among them.
struct StrokeErrors {
  double stated = 0.0, median = 0.0, most = 0.0;
};
StrokeErrors overStrokes(std::vector<double> errors);
// "the 90th percentile of 12 random strokes".
std::string strokesWords(int strokes);

// RMS |a - b| over RMS |b|, in percent; 0 where b is nothing and a is too, else 100.
double rmsError_percent(const std::vector<Vec3>& a, const std::vector<Vec3>& b);

}  // namespace trephine
