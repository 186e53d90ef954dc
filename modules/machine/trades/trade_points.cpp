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

Quat about(const Vec3& axis, double angle) {
  const Vec3 part = std::sin(0.5 * angle) * axis;
  return {std::cos(0.5 * angle), part.x, part.y, part.z};
}

// Into the shell's top at a slant, along it and out again, the tool leaning and turning.
struct ObliqueStroke {
  Vec3 along, leans_to, aside_mm;
  double length_mm, deep_mm, lean, sway, sways;

  explicit ObliqueStroke(int stroke) {
    StrokeDice dice(stroke);
    along = dice.heading();
    leans_to = dice.heading();
    aside_mm = dice.heading();
    aside_mm *= dice.between(0.0, 4.0);
    length_mm = dice.between(12.0, 28.0);
    deep_mm = dice.between(3.0, 7.0);
    lean = dice.between(0.1, 0.7);
    sway = dice.between(0.1, 0.4);
    sways = dice.between(2.0, 6.0);
  }
  Pose pose_mm(double part) const {
    const double top_mm = EllipsoidShell().half_axes_mm.z;
    const double deep = deep_mm * std::sin(3.14159265358979 * part) - 1.0;
    const Vec3 at = aside_mm + (length_mm * (part - 0.5)) * along;
    return {{at.x, at.y, top_mm - deep},
            about({-leans_to.y, leans_to.x, 0.0}, lean + sway * std::sin(sways * part))};
  }
};

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
  // The force with the tissue left whole, and what goes where it may.
  struct Run {
    StrokeRun whole;
    double removed = 0.0;
  };
  const auto run = [&](int points, const ObliqueStroke& of, int times) -> std::optional<Run> {
    const auto stroke = [&](bool cuttable) {
      return runStroke(
          tradeParameters(toolOf(kind, points), tradeTissue(226, cuttable, kSoftToCut_J_per_mm3),
                          {LawKind::viscous, LawKind::coulomb}, ForceAt::distributed,
                          kTradePeriod_s),
          grid, ticks, [&](double t_s) { return of.pose_mm(t_s / options.stroke_s); }, cuttable,
          progress);
    };
    std::optional<StrokeRun> whole = leastCost([&] { return stroke(false); }, times);
    std::optional<StrokeRun> cut = stroke(true);
    if (cut) putBack(grid, *cut);
    if (!whole || !cut) return {};
    return Run{std::move(*whole), double(cut->removed.size())};
  };
  const int most = *std::max_element(counts.begin(), counts.end());
  struct Wrong {
    std::vector<double> force, volume;
    double tick_ns = 0.0;
  };
  std::vector<Wrong> wrong(counts.size());
  for (int n = 0; n < options.strokes; ++n) {
    const ObliqueStroke stroke(options.first_stroke + n);
    const std::optional<Run> reference = run(kReferenceTimes * most, stroke, 1);
    if (!reference) return tradesCancelled();
    for (std::size_t c = 0; c < counts.size(); ++c) {
      const std::optional<Run> one = run(counts[c], stroke, n == 0 ? kTimes : 1);
      if (!one) return tradesCancelled();
      wrong[c].force.push_back(
          rmsError_percent(one->whole.demanded_N, reference->whole.demanded_N));
      wrong[c].volume.push_back(reference->removed > 0.0
                                    ? 100.0 * std::abs(one->removed / reference->removed - 1.0)
                                    : (one->removed > 0.0 ? 100.0 : 0.0));
      if (n == 0) wrong[c].tick_ns = one->whole.tick_ns;
    }
  }
  std::vector<TradeRow> rows;
  for (std::size_t c = 0; c < counts.size(); ++c) {
    const StrokeErrors force = overStrokes(wrong[c].force), volume = overStrokes(wrong[c].volume);
    TradeRow row;
    row.knob = kind == ToolKind::burr ? "points_burr" : "points_blade";
    row.setting = std::to_string(counts[c]);
    row.error = force.stated;
    row.error_unit = "% of force";
    row.cost = wrong[c].tick_ns;
    row.cost_unit = "ns per tick without removal";
    row.reference =
        tr("RMS force over an oblique stroke through the surface of bone, and the volume it "
           "removes by the hand's work, with {} points; {}",
           kReferenceTimes * most, strokesWords(options.strokes));
    row.extra = {{"volume_error_percent", volume.stated},
                 {"error_median", force.median},
                 {"error_most", force.most}};
    rows.push_back(row);
  }
  return rows;
}

TradeRows tradeForceAt(const TradesOptions& options, const Progress& progress) {
  constexpr double kLength_m = 16e-3, kMost_rad = 0.8;
  Grid grid(block(options.grid, 49.2));
  const TissueTable tissues = tradeTissue(226, false, 1.0);
  const double b = tissues.classes[0].damping_Ns_per_m;
  const double thick_m = makeBlade(kLength_m, 64).point_inset_m;
  std::vector<double> wrong[std::size(kForceAtNames)], costs_ns(std::size(kForceAtNames), 0.0);
  for (int stroke = 0; stroke < options.strokes; ++stroke) {
    StrokeDice dice(options.first_stroke + stroke);
    Vec3 velocity_m_s = dice.heading();
    velocity_m_s *= dice.between(5e-3, 14e-3);
    const Vec3 across = dice.heading();  // the axis about which it turns
    const Vec3 ahead(-across.y, across.x, 0.0);
    const double deep_m = dice.between(5e-3, 10e-3), turn_rad_per_s = dice.between(1.0, 3.0);
    const double half_s = kMost_rad / turn_rad_per_s;
    const auto ticks = std::size_t(2.0 * half_s / kTradePeriod_s);
    const auto angle = [&](double t_s) { return turn_rad_per_s * (t_s - half_s); };
    const auto pose_mm = [&](double t_s) {
      return Pose{1000.0 * (velocity_m_s * (t_s - half_s) + Vec3(0.0, 0.0, -deep_m)),
                  about(across, angle(t_s))};
    };
    // -(b / L) integral from 0 to s of (v + omega x u r) dr, s where the blade leaves the tissue,
    // which its points feel as far as it is thick.
    std::vector<Vec3> exact_N;
    for (std::size_t n = 0; n < ticks; ++n) {
      const double a = angle(double(n) * kTradePeriod_s);
      const Vec3 along = std::cos(a) * Vec3(0.0, 0.0, 1.0) - std::sin(a) * ahead;
      const Vec3 turning = glm::cross(turn_rad_per_s * across, along);
      const double s = std::min(kLength_m, (deep_m + thick_m) / std::cos(a));
      exact_N.push_back(-(b / kLength_m) * (velocity_m_s * s + turning * (0.5 * s * s)));
    }
    for (std::size_t k = 0; k < std::size(kForceAtNames); ++k) {
      const HapticParameters parameters =
          tradeParameters(makeBlade(kLength_m, 64), tissues, {LawKind::viscous},
                          kForceAtNames[k].second, kTradePeriod_s);
      std::optional<StrokeRun> run =
          leastCost([&] { return runStroke(parameters, grid, ticks, pose_mm, false, progress); },
                    stroke == 0 ? kTimes : 1);
      if (!run) return tradesCancelled();
      // The first sample still has the velocity of the way there.
      run->demanded_N[0] = exact_N[0];
      wrong[k].push_back(rmsError_percent(run->demanded_N, exact_N));
      if (stroke == 0) costs_ns[k] = run->tick_ns;
    }
  }
  std::vector<TradeRow> rows;
  for (std::size_t k = 0; k < std::size(kForceAtNames); ++k) {
    const StrokeErrors force = overStrokes(wrong[k]);
    TradeRow row;
    row.knob = "force_at";
    row.setting = std::string(kForceAtNames[k].first);
    row.error = force.stated;
    row.error_unit = "% of force";
    row.cost = costs_ns[k];
    row.cost_unit = "ns per tick without removal";
    row.reference =
        tr("RMS force of the line integral of eq. 1 along a blade of 16 mm, partly in tissue, that "
           "turns at 1 to 3 rad/s; {}",
           strokesWords(options.strokes));
    row.extra = {{"error_median", force.median}, {"error_most", force.most}};
    rows.push_back(row);
  }
  return rows;
}

}  // namespace trephine
