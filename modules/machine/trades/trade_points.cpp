// Points of a tool, and where the force acts.
#include <algorithm>
#include <cmath>

#include "base/tr.h"
#include "machine/common/shell_phantom.h"
#include "machine/trades/trade_knobs.h"
#include "machine/trades/trade_stroke.h"

namespace trephine {

namespace {

// Soft to cut, so that a hand's work takes enough voxels to count by.
constexpr double kSoftToCut_J_per_mm3 = 0.004;
constexpr int kReferenceTimes = 8;

constexpr int kTimes = 3;

// What else the machine does only adds to the cost of a run: the cheapest of several counts.
template <class Stroke>
std::optional<StrokeRun> leastCost(Stroke&& stroke, int times) {
  std::optional<StrokeRun> least;
  for (int n = 0; n < times; ++n) {
    std::optional<StrokeRun> run = stroke();
    if (!run) return {};
    if (!least || run->tick_ns < least->tick_ns) least = std::move(run);
  }
  return least;
}

Tool toolOf(ToolKind kind, int points) {
  return kind == ToolKind::burr ? makeBurr(3e-3, points, 0, 0.06) : makeBlade(16e-3, points);
}

Quat aboutY(double angle) {
  return {std::cos(0.5 * angle), 0.0, std::sin(0.5 * angle), 0.0};
}

// Into the shell's top at a slant, along it and out again, the tool leaning and turning.
Pose obliquePose_mm(double t_s, double duration_s) {
  const double part = t_s / duration_s;
  const double top_mm = EllipsoidShell().half_axes_mm.z;
  const double deep_mm = 6.0 * std::sin(3.14159265358979 * part) - 1.0;
  return {{-12.0 + 24.0 * part, 3.0 * part, top_mm - deep_mm},
          aboutY(0.5 + 0.3 * std::sin(4.0 * part))};
}

// Tissue below z = 0, a plane between voxels.
Volume block(int size, double box_mm) {
  Volume volume;
  volume.geometry = cubeGeometry(size, box_mm, Vec3(0.0));
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  std::fill_n(volume.hu.begin(), volume.geometry.voxelCount() / 2, std::int16_t(1000));
  return volume;
}

}  // namespace

TradeRows tradePoints(ToolKind kind, const std::vector<int>& counts, const TradesOptions& options,
                      const Progress& progress) {
  Grid grid(shellTop(options.grid, 49.2));
  const auto ticks = std::size_t(std::llround(options.stroke_s / kTradePeriod_s));
  const auto pose_mm = [&](double t_s) { return obliquePose_mm(t_s, options.stroke_s); };
  // The force with the tissue left whole, and what goes where it may.
  struct Run {
    StrokeRun whole;
    double removed = 0.0;
  };
  const auto run = [&](int points, int times) -> std::optional<Run> {
    const auto stroke = [&](bool cuttable) {
      return runStroke(
          tradeParameters(toolOf(kind, points), tradeTissue(226, cuttable, kSoftToCut_J_per_mm3),
                          {LawKind::viscous, LawKind::coulomb}, ForceAt::distributed,
                          kTradePeriod_s),
          grid, ticks, pose_mm, cuttable, progress);
    };
    std::optional<StrokeRun> whole = leastCost([&] { return stroke(false); }, times);
    std::optional<StrokeRun> cut = stroke(true);
    if (cut) putBack(grid, *cut);
    if (!whole || !cut) return {};
    return Run{std::move(*whole), double(cut->removed.size())};
  };
  const int most = *std::max_element(counts.begin(), counts.end());
  const std::optional<Run> reference = run(kReferenceTimes * most, 1);
  if (!reference) return tradesCancelled();
  std::vector<TradeRow> rows;
  for (int points : counts) {
    const std::optional<Run> one = run(points, kTimes);
    if (!one) return tradesCancelled();
    TradeRow row;
    row.knob = kind == ToolKind::burr ? "points_burr" : "points_blade";
    row.setting = std::to_string(points);
    row.error = rmsError_percent(one->whole.demanded_N, reference->whole.demanded_N);
    row.error_unit = "% of force";
    row.cost = one->whole.tick_ns;
    row.cost_unit = "ns per tick without removal";
    row.reference =
        tr("RMS force over an oblique stroke through the surface of bone, and the volume it "
           "removes by the hand's work, with {} points",
           kReferenceTimes * most);
    const double volume_error =
        reference->removed > 0.0 ? std::abs(one->removed / reference->removed - 1.0) : 1.0;
    row.extra = {{"volume_error_percent", 100.0 * volume_error}};
    rows.push_back(row);
  }
  return rows;
}

TradeRows tradeForceAt(const TradesOptions& options, const Progress& progress) {
  constexpr double kLength_m = 16e-3, kDeep_m = 8e-3, kTurn_rad_per_s = 2.0, kMost_rad = 0.8;
  const Vec3 velocity_m_s(0.010, 0.004, 0.0);
  Grid grid(block(options.grid, 49.2));
  const TissueTable tissues = tradeTissue(226, false, 1.0);
  const double b = tissues.classes[0].damping_Ns_per_m;
  const auto ticks = std::size_t(2.0 * kMost_rad / kTurn_rad_per_s / kTradePeriod_s);
  const auto angle = [&](double t_s) { return -kMost_rad + kTurn_rad_per_s * t_s; };
  const auto pose_mm = [&](double t_s) {
    return Pose{1000.0 * (velocity_m_s * (t_s - 0.4) + Vec3(0.0, 0.0, -kDeep_m)),
                aboutY(angle(t_s))};
  };
  // -(b / L) integral from 0 to s of (v + omega x u r) dr, s where the blade leaves the tissue.
  std::vector<Vec3> exact_N;
  for (std::size_t n = 0; n < ticks; ++n) {
    const double a = angle(double(n) * kTradePeriod_s);
    const Vec3 along(std::sin(a), 0.0, std::cos(a));
    const Vec3 turning = glm::cross(Vec3(0.0, kTurn_rad_per_s, 0.0), along);
    const double s = std::min(kLength_m, kDeep_m / std::cos(a));
    exact_N.push_back(-(b / kLength_m) * (velocity_m_s * s + turning * (0.5 * s * s)));
  }
  exact_N[0] = Vec3(0.0);  // the first sample has no velocity yet
  std::vector<TradeRow> rows;
  for (const auto& [name, kind] : kForceAtNames) {
    const HapticParameters parameters = tradeParameters(makeBlade(kLength_m, 64), tissues,
                                                        {LawKind::viscous}, kind, kTradePeriod_s);
    const std::optional<StrokeRun> run = leastCost(
        [&] { return runStroke(parameters, grid, ticks, pose_mm, false, progress); }, kTimes);
    if (!run) return tradesCancelled();
    TradeRow row;
    row.knob = "force_at";
    row.setting = std::string(name);
    row.error = rmsError_percent(run->demanded_N, exact_N);
    row.error_unit = "% of force";
    row.cost = run->tick_ns;
    row.cost_unit = "ns per tick without removal";
    row.reference =
        "RMS force of the line integral of eq. 1 along a blade of 16 mm, half in "
        "tissue, that turns at 2 rad/s";
    rows.push_back(row);
  }
  return rows;
}

}  // namespace trephine
