#include "machine/trades/trade_stroke.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/tr.h"
#include "machine/common/quantile.h"

namespace trephine {

TissueTable tradeTissue(int hu_min, bool cuttable, double cutting_J_per_mm3) {
  TissueTable table;
  table.count = 1;
  TissueClass& bone = table.classes[0];
  bone.hu_min = hu_min;
  bone.hu_max = 3071;
  bone.damping_Ns_per_m = 12.0;
  bone.stiffness_N_per_m = 900.0;
  bone.friction_N = 2.0;
  bone.cutting_J_per_mm3 = cutting_J_per_mm3;
  bone.cuttable = cuttable;
  bone.solid = 1;
  return table;
}

HapticParameters tradeParameters(const Tool& tool, const TissueTable& tissues,
                                 const std::vector<LawKind>& laws, ForceAt force_at,
                                 double period_s) {
  HapticParameters parameters;
  parameters.period_s = period_s;
  parameters.laws = laws;
  parameters.force_at = force_at;
  parameters.controller = ControllerKind::off;
  parameters.tissues = tissues;
  parameters.journal_voxels = 1 << 22;  // more than any stroke here takes
  parameters.journal_strokes = parameters.journal_seconds = 1024;
  ArmParameters arm;
  arm.tool = tool;
  arm.max_force_N = 3.3;
  arm.dynamics.encoder_step_m = 5.5e-5;
  parameters.arms = {arm};
  return parameters;
}

std::optional<StrokeRun> runStroke(const HapticParameters& parameters, Grid& grid,
                                   std::size_t ticks,
                                   const std::function<Pose(double t_s)>& pose_mm, bool removes,
                                   const Progress& progress) {
  StrokeRun run;
  std::vector<double> ns;
  HapticCore core(parameters, *grid.takeWriter());
  TickInput input;
  TickRecord record;
  // From above, at 25 mm/s: a tool that starts in tissue has no force.
  const auto lead_in = std::int64_t(std::llround(0.4 / parameters.period_s));
  for (std::int64_t n = -lead_in; n < std::int64_t(ticks); ++n) {
    if (progress.cancelled()) return {};
    Pose pose = pose_mm(double(std::max<std::int64_t>(0, n)) * parameters.period_s);
    pose.position.z += 10.0 * double(std::max<std::int64_t>(0, -n)) / double(lead_in);
    input.arms[0].position_m = 0.001 * pose.position;
    input.arms[0].orientation = pose.orientation;
    input.journal = core.journalState();
    if (!removes) input.journal &= ~std::uint32_t(kJournalRoom);
    const auto begin = std::chrono::steady_clock::now();
    core.tick(input, nullptr, 0, record);
    ++input.tick;
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begin;
    if (n >= 0) {
      ns.push_back(took.count());
      run.demanded_N.push_back(record.arms[0].demanded_N);
    }
    for (const CarveRecord& carve : core.carves()) {
      run.removed.push_back(carve.voxel);
      run.removed_hu.push_back(carve.old_hu);
    }
  }
  run.tick_ns = meanOf(ns);
  return run;
}

void putBack(Grid& grid, const StrokeRun& run) {
  Grid::Writer writer = *grid.takeWriter();
  for (std::size_t n = 0; n < run.removed.size(); ++n) {
    writer.store(run.removed[n], run.removed_hu[n]);
  }
}

StrokeErrors overStrokes(std::vector<double> errors) {
  std::sort(errors.begin(), errors.end());
  return {quantile(errors, 900), quantile(errors, 500), quantile(errors, 1000)};
}

std::string strokesWords(int strokes) {
  return tr("the 90th percentile of {} random strokes", strokes);
}

double rmsError_percent(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double error2 = 0.0, size2 = 0.0;
  for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n) {
    error2 += glm::dot(a[n] - b[n], a[n] - b[n]);
    size2 += glm::dot(b[n], b[n]);
  }
  if (!(size2 > 0.0)) return error2 > 0.0 ? 100.0 : 0.0;
  return 100.0 * std::sqrt(error2 / size2);
}

}  // namespace trephine
