#include "lab/touch/sliding_measurement.h"

#include <cmath>
#include <numbers>

#include "base/codes.h"
#include "haptics/haptic_core.h"
#include "machine/common/quantile.h"
#include "machine/common/shell_phantom.h"

namespace trephine {

namespace {

constexpr double kBox_mm = 200.0;
constexpr double kRadius_m = 1.5e-3;
constexpr double kDepth_m = 0.5e-3;
constexpr double kStiffness_N_per_m = 500.0;
constexpr double kSpeed_mm_per_s = 30.0;
constexpr double kPeriod_s = 1e-3;
constexpr std::uint32_t kSeed = 1;

HapticParameters elasticAlone() {
  HapticParameters parameters;
  parameters.period_s = kPeriod_s;
  parameters.laws = {LawKind::elastic};
  parameters.controller = ControllerKind::off;
  parameters.tissues.count = 1;
  TissueClass& bone = parameters.tissues.classes[0];
  // As the exercises' bone. Half-way from air to this shell is 0 HU, so that bone begins a little
  // below the true surface, by the more the coarser the grid: most of the error of depth.
  bone.hu_min = 226;
  bone.hu_max = 3071;
  bone.stiffness_N_per_m = kStiffness_N_per_m;
  bone.solid = 1;
  parameters.journal_voxels = 1024;
  parameters.journal_strokes = parameters.journal_seconds = 64;
  ArmParameters arm;
  arm.tool = makeBurr(kRadius_m, 16, 0, 2.0 * kRadius_m);  // no shaft: it stands upright everywhere
  arm.max_force_N = 3.3;
  parameters.arms = {arm};
  return parameters;
}

// The axis of path n of `count`: evenly over half of all directions.
Vec3 pathAxis(int n, int count) {
  const double z = (n + 0.5) / count, flat = std::sqrt(1.0 - z * z);
  const double angle = n * std::numbers::pi * (3.0 - std::sqrt(5.0));
  return {flat * std::cos(angle), flat * std::sin(angle), z};
}

std::vector<SlidingTick> slide(HapticCore& core, const EllipsoidShell& shell, const Vec3& axis,
                               std::size_t ticks) {
  const Vec3 across = glm::normalize(glm::cross(axis, Vec3(0.31, 0.52, 0.79)));
  const Vec3 onward = glm::cross(axis, across);
  const auto surface_mm = [&](double angle) {
    return surfacePoint_mm(shell, std::cos(angle) * across + std::sin(angle) * onward);
  };
  std::vector<SlidingTick> path;
  double angle = 0.0;
  // From outside: what a tool starts in gives no force.
  constexpr int kLeadInTicks = 100;
  constexpr double kLeadIn_m = 4e-3;
  for (int n = -kLeadInTicks; n < int(ticks); ++n) {
    const Vec3 at_mm = surface_mm(angle);
    SlidingTick tick;
    tick.normal = surfaceNormal(shell, at_mm);
    const double out_m = kLeadIn_m * std::max(0, -n) / kLeadInTicks;
    const Vec3 centre_m = 0.001 * at_mm + (kRadius_m - kDepth_m + out_m) * tick.normal;
    TickInput input;
    input.tick = std::uint64_t(n + kLeadInTicks);
    input.journal = core.journalState();
    input.arms[0].position_m = centre_m - Vec3(0.0, 0.0, kRadius_m);  // the tip, the tool upright
    TickRecord record;
    core.tick(input, nullptr, 0, record);
    if (n < 0) continue;
    tick.force_N = record.arms[0].demanded_N;
    path.push_back(tick);
    constexpr double kSmall = 1e-5;
    const double mm_per_radian =
        glm::length(surface_mm(angle + kSmall) - surface_mm(angle)) / kSmall;
    angle += kSpeed_mm_per_s * kPeriod_s / mm_per_radian;
  }
  return path;
}

}  // namespace

SlidingMeasurement judgeSliding(const std::vector<std::vector<SlidingTick>>& paths, double true_N) {
  std::vector<double> off_deg, steps_N;
  double sum_N = 0.0;
  for (const std::vector<SlidingTick>& path : paths) {
    for (std::size_t n = 0; n < path.size(); ++n) {
      const double size_N = glm::length(path[n].force_N);
      sum_N += size_N;
      const double cosine =
          size_N > 0.0 ? glm::dot(path[n].force_N, path[n].normal) / size_N : -1.0;
      off_deg.push_back(std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi);
      if (n > 0) steps_N.push_back(glm::length(path[n].force_N - path[n - 1].force_N));
    }
  }
  SlidingMeasurement out;
  out.ticks = off_deg.size();
  if (off_deg.empty()) return out;
  std::sort(off_deg.begin(), off_deg.end());
  std::sort(steps_N.begin(), steps_N.end());
  const double mean_N = sum_N / double(off_deg.size());
  out.direction_median_deg = quantile(off_deg, 500);
  out.direction_p99_deg = quantile(off_deg, 990);
  // Without any force there is nothing to be smooth.
  out.step_p99_percent = mean_N > 0.0 ? 100.0 * quantile(steps_N, 990) / mean_N : 100.0;
  out.depth_error_percent = 100.0 * (mean_N / true_N - 1.0);
  return out;
}

Result<SlidingMeasurement> measureSliding(const SlidingOptions& options, const Progress& progress,
                                          double from, double to) {
  if (options.grid < 32 || options.grid > 512 || options.paths < 1 || options.paths > 1000 ||
      !(options.seconds >= 0.01 && options.seconds <= 60.0) ||
      !(options.noise_hu >= 0.0 && options.noise_hu <= 500.0)) {
    return Error{code::kBadArgument,
                 "A slide needs a grid of 32 to 512, 1 to 1000 paths of 0.01 to 60 s and noise of "
                 "0 to 500 HU",
                 "the options of the slide", ""};
  }
  progress.at(from, "sliding");
  const EllipsoidShell shell;
  Grid grid(
      scannedShell(shell, cubeGeometry(options.grid, kBox_mm, Vec3(0.0)), options.noise_hu, kSeed));
  const auto ticks = std::size_t(std::llround(options.seconds / kPeriod_s));
  std::vector<std::vector<SlidingTick>> paths;
  for (int n = 0; n < options.paths; ++n) {
    if (progress.cancelled()) {
      return Error{code::kCancelled, "The measurement was cancelled", "measure haptics", ""};
    }
    progress.at(from + (to - from) * n / options.paths, "sliding");
    HapticCore core(elasticAlone(), *grid.takeWriter());
    paths.push_back(slide(core, shell, pathAxis(n, options.paths), ticks));
  }
  return judgeSliding(paths, kStiffness_N_per_m * kDepth_m);
}

}  // namespace trephine
