// The grid's resolution: the same channels milled into the same bone.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

#include "base/tr.h"
#include "haptics/contact.h"
#include "machine/common/shell_phantom.h"
#include "machine/trades/trade_knobs.h"
#include "machine/trades/trade_stroke.h"

namespace trephine {

namespace {

constexpr int kTissue_hu = 226;

// A channel over the top of the shell, straight from above.
struct Channel {
  Vec3 along, aside_mm;
  double deep_mm, length_mm;

  explicit Channel(int stroke) {
    StrokeDice dice(stroke);
    along = dice.heading();
    aside_mm = dice.heading();
    aside_mm *= dice.between(0.0, 4.0);
    deep_mm = dice.between(1.0, 2.5);
    length_mm = dice.between(12.0, 24.0);
  }
  Pose pose_mm(double t_s, double duration_s) const {
    const Vec3& a = EllipsoidShell().half_axes_mm;
    const Vec3 at = aside_mm + (length_mm * (t_s / duration_s - 0.5)) * along;
    const double x = at.x / a.x, y = at.y / a.y;
    const double high = std::sqrt(std::max(0.0, 1.0 - x * x - y * y));
    return {{at.x, at.y, a.z * high - deep_mm}, Quat(1, 0, 0, 0)};
  }
};

// The height of the first tissue below the box's top at (x, y), in steps of `step_mm`.
double surfaceHeight_mm(const Grid& grid, const Mat4& to_voxel, double x_mm, double y_mm,
                        double from_mm, double to_mm, double step_mm) {
  for (double z_mm = from_mm; z_mm > to_mm; z_mm -= step_mm) {
    const Vec3 place(to_voxel * glm::dvec4(x_mm, y_mm, z_mm, 1.0));
    const std::int64_t voxel = TissueField::voxelAt(grid.geometry(), place);
    if (voxel >= 0 && grid.hu(std::size_t(voxel)) >= kTissue_hu) return z_mm;
  }
  return to_mm;
}

// Heights over the columns of the fine grid that the channel lies in.
std::vector<double> channelHeights_mm(const Grid& grid, const GridGeometry& fine,
                                      const std::set<std::pair<int, int>>& columns) {
  const Mat4 to_voxel = grid.geometry().patientToVoxel();
  const double top_mm = EllipsoidShell().half_axes_mm.z;
  std::vector<double> heights;
  for (const auto& [i, j] : columns) {
    const Vec3 at_mm = fine.toPatient_mm({i, j, 0});
    heights.push_back(surfaceHeight_mm(grid, to_voxel, at_mm.x, at_mm.y, top_mm + 3.0,
                                       top_mm - 12.0, 0.25 * fine.spacing_mm.z));
  }
  return heights;
}

}  // namespace

Volume averaged(const Volume& fine, int factor) {
  Volume coarse;
  const GridGeometry& from = fine.geometry;
  GridGeometry& g = coarse.geometry;
  g = from;
  for (int& edge : g.size) edge /= factor;
  g.spacing_mm = from.spacing_mm * double(factor);
  g.origin_mm = from.origin_mm + 0.5 * (factor - 1) * from.spacing_mm;
  coarse.hu.reserve(g.voxelCount());
  for (int k = 0; k < g.size[2]; ++k) {
    for (int j = 0; j < g.size[1]; ++j) {
      for (int i = 0; i < g.size[0]; ++i) {
        double sum = 0.0;
        for (int n = 0; n < factor * factor * factor; ++n) {
          sum += fine.at(factor * i + n % factor, factor * j + n / factor % factor,
                         factor * k + n / factor / factor);
        }
        coarse.hu.push_back(std::int16_t(std::lround(sum / (factor * factor * factor))));
      }
    }
  }
  return coarse;
}

TradeRows tradeGrid(const TradesOptions& options, const Progress& progress) {
  const Volume fine = shellTop(options.grid, 49.2);
  ToolDescription burr;
  burr.kind = ToolKind::burr;
  burr.length_mm = 60.0;
  burr.radius_mm = 3.0;
  burr.points = 64;
  burr.motor_W = 4.0;
  const HapticParameters parameters = tradeParameters(
      *makeTool(burr), tradeTissue(kTissue_hu, true, 0.06),
      {LawKind::viscous, LawKind::coulomb, LawKind::elastic}, ForceAt::tip, kTradePeriod_s);
  const auto ticks = std::size_t(std::llround(options.stroke_s / kTradePeriod_s));
  struct OfGrid {
    const char* name;
    int factor;
    std::vector<double> volume_percent{}, off_mm{}, removed_mm3{}, tick_ns{};
    double megabytes = 0.0;
  };
  std::vector<OfGrid> grids{{"full", 1}, {"half", 2}, {"quarter", 4}};
  // By stroke: what was taken of the full grid, its columns, and how deep.
  struct Full {
    std::set<std::pair<int, int>> columns;
    std::vector<double> heights_mm;
    double mm3 = 0.0;
  };
  std::vector<Full> full(std::size_t(options.strokes));
  for (OfGrid& of : grids) {
    Grid grid(averaged(fine, of.factor));
    const GridGeometry& g = grid.geometry();
    of.megabytes = double(g.voxelCount()) * sizeof(std::int16_t) / (1024.0 * 1024.0);
    for (std::size_t n = 0; n < full.size(); ++n) {
      const Channel channel(options.first_stroke + int(n));
      const std::optional<StrokeRun> run = runStroke(
          parameters, grid, ticks,
          [&](double t_s) { return channel.pose_mm(t_s, options.stroke_s); }, true, progress);
      if (!run) return tradesCancelled();
      Full& reference = full[n];
      const double mm3 = double(run->removed.size()) * g.voxelVolume_mm3();
      if (of.factor == 1) {
        for (std::size_t voxel : run->removed) {
          const Index3 v = g.indicesOf(voxel);
          reference.columns.insert({v[0], v[1]});
        }
        reference.mm3 = mm3;
      }
      const std::vector<double> heights_mm =
          channelHeights_mm(grid, fine.geometry, reference.columns);
      if (of.factor == 1) reference.heights_mm = heights_mm;
      double off_mm = 0.0;
      for (std::size_t c = 0; c < heights_mm.size(); ++c) {
        off_mm += std::abs(heights_mm[c] - reference.heights_mm[c]);
      }
      of.off_mm.push_back(heights_mm.empty() ? 1e3 : off_mm / double(heights_mm.size()));
      of.volume_percent.push_back(reference.mm3 > 0.0 ? 100.0 * std::abs(mm3 / reference.mm3 - 1.0)
                                                      : 100.0);
      of.removed_mm3.push_back(mm3);
      of.tick_ns.push_back(run->tick_ns);
      putBack(grid, *run);
    }
  }
  std::vector<TradeRow> rows;
  for (const OfGrid& of : grids) {
    const StrokeErrors volume = overStrokes(of.volume_percent);
    TradeRow row;
    row.knob = "grid";
    row.setting = of.name;
    row.error = volume.stated;
    row.error_unit = "% of removed volume";
    row.cost = of.megabytes;
    row.cost_unit = "MB";
    row.reference = tr("the same channel milled in the full grid: its volume, and its floor; {}",
                       strokesWords(options.strokes));
    row.extra = {{"surface_distance_mm", overStrokes(of.off_mm).stated},
                 {"tick_ns", overStrokes(of.tick_ns).median},
                 {"removed_mm3", overStrokes(of.removed_mm3).median},
                 {"error_median", volume.median},
                 {"error_most", volume.most}};
    rows.push_back(row);
  }
  return rows;
}

}  // namespace trephine
