// The grid's resolution: the same channel milled into the same bone.
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

// A channel 1.5 mm deep over the top of the shell, at 10 mm/s.
Pose channelPose_mm(double t_s, double duration_s) {
  const Vec3& a = EllipsoidShell().half_axes_mm;
  const double x_mm = 10.0 * (t_s - 0.5 * duration_s);
  return {{x_mm, 0.0, a.z * std::sqrt(1.0 - x_mm * x_mm / (a.x * a.x)) - 1.5}, Quat(1, 0, 0, 0)};
}

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
  std::vector<TradeRow> rows;
  std::set<std::pair<int, int>> columns;
  std::vector<double> full_mm;
  double full_mm3 = 0.0;
  for (const auto& [name, factor] :
       {std::pair("full", 1), std::pair("half", 2), std::pair("quarter", 4)}) {
    Grid grid(averaged(fine, factor));
    const std::optional<StrokeRun> run = runStroke(
        parameters, grid, ticks, [&](double t_s) { return channelPose_mm(t_s, options.stroke_s); },
        true, progress);
    if (!run) return tradesCancelled();
    const GridGeometry& g = grid.geometry();
    if (factor == 1) {
      for (std::size_t voxel : run->removed) {
        const Index3 v = g.indicesOf(voxel);
        columns.insert({v[0], v[1]});
      }
    }
    const std::vector<double> heights_mm = channelHeights_mm(grid, fine.geometry, columns);
    const double removed_mm3 = double(run->removed.size()) * g.voxelVolume_mm3();
    if (factor == 1) {
      full_mm3 = removed_mm3;
      full_mm = heights_mm;
    }
    double off_mm = 0.0;
    for (std::size_t n = 0; n < full_mm.size(); ++n) off_mm += std::abs(heights_mm[n] - full_mm[n]);
    TradeRow row;
    row.knob = "grid";
    row.setting = name;
    row.error = full_mm3 > 0.0 ? 100.0 * std::abs(removed_mm3 / full_mm3 - 1.0) : 100.0;
    row.error_unit = "% of removed volume";
    row.cost = double(g.voxelCount()) * sizeof(std::int16_t) / (1024.0 * 1024.0);
    row.cost_unit = "MB";
    row.reference = "the same channel milled in the full grid: its volume, and its floor";
    row.extra = {{"surface_distance_mm", full_mm.empty() ? 1e3 : off_mm / double(full_mm.size())},
                 {"tick_ns", run->tick_ns},
                 {"removed_mm3", removed_mm3}};
    rows.push_back(row);
  }
  return rows;
}

}  // namespace trephine
