#include "lab/touch/haptics_measurement.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <iterator>
#include <locale>
#include <memory>
#include <numbers>
#include <sstream>
#include <tuple>
#include <utility>

#include "base/codes.h"
#include "base/file.h"
#include "haptics/haptic_core.h"
#include "machine/common/quantile.h"
#include "machine/common/shell_phantom.h"
#include "volume/journal_file.h"

namespace trephine {

namespace {

constexpr double kPeriod_s = 1e-3;
// A tool comes from outside: what it starts in gives no force.
constexpr int kLeadInTicks = 400;
constexpr double kLeadIn_mm = 12.0;
constexpr std::size_t kJournalVoxels = 1 << 20;
constexpr int kServeEvery = 20;  // ticks, as the recorder does
constexpr TouchPhase kPhases[] = {TouchPhase::free, TouchPhase::contact, TouchPhase::removal};
constexpr const char* kTools[] = {"needle", "blade64", "burr6"};
constexpr double kSlidingShare = 0.2;  // of the progress

Tool toolNamed(const std::string& name) {
  ToolDescription d;
  if (name == "needle") {
    d.length_mm = 80.0;
  } else if (name == "blade64") {
    d.kind = ToolKind::blade;
    d.length_mm = 16.0;
    d.points = 64;
    d.motor_W = 6.0;
  } else {
    d.kind = ToolKind::burr;
    d.length_mm = 60.0;
    d.points = 64;
    d.shaft_points = 8;
    d.radius_mm = 3.0;
    d.motor_W = 4.0;
  }
  return *makeTool(d);
}

TissueTable bone(bool cuttable) {
  TissueTable table;
  table.count = 1;
  TissueClass& c = table.classes[0];
  c.hu_min = 226;
  c.hu_max = 3071;
  c.damping_Ns_per_m = 12.0;
  c.stiffness_N_per_m = 900.0;
  c.friction_N = 2.0;
  c.cutting_J_per_mm3 = 0.06;
  c.cuttable = cuttable;
  c.solid = 1;
  return table;
}

HapticParameters parametersOf(const HapticsRow& row) {
  HapticParameters parameters;
  parameters.period_s = kPeriod_s;
  parameters.laws = {LawKind::viscous, LawKind::coulomb, LawKind::elastic};
  parameters.force_at = ForceAt::distributed;
  parameters.controller = ControllerKind::bounded;
  parameters.removal = RemovalKind::work;
  parameters.tissues = bone(row.phase == TouchPhase::removal);
  parameters.journal_voxels = kJournalVoxels;
  ArmParameters arm;
  arm.tool = toolNamed(row.tool);
  arm.max_force_N = 3.3;
  arm.dynamics.encoder_step_m = 5.5e-5;
  parameters.arms.assign(std::size_t(row.arms), arm);
  return parameters;
}

// Where a tool is after a time, patient axes and millimetres: to and fro over the top of the shell
// in lanes of 16 mm, 3 mm apart, the second arm beside the first. The depth goes up and down, so
// that the motor's work now suffices for what the tool sweeps and now does not.
Pose strokePose_mm(const EllipsoidShell& shell, const HapticsRow& row, int arm, double t_s) {
  constexpr double kLane_mm = 16.0, kShift_mm = 3.0, kLanes = 12.0;
  const double way_mm = 14.5 * t_s + 4.5 / 3.0 * (1.0 - std::cos(3.0 * t_s));
  const double lanes = std::fmod(way_mm / kLane_mm, kLanes);
  const double within = std::fmod(lanes, 2.0);
  const double x_mm = (arm == 0 ? -20.0 : 4.0) + kLane_mm * (within < 1.0 ? within : 2.0 - within);
  const double y_mm = kShift_mm * (lanes - 0.5 * kLanes);
  const Vec3& a = shell.half_axes_mm;
  const double height =
      a.z * std::sqrt(1.0 - x_mm * x_mm / (a.x * a.x) - y_mm * y_mm / (a.y * a.y));
  const double wave = std::sin(2.0 * std::numbers::pi * way_mm / 11.0);
  const double depth_mm = row.phase == TouchPhase::free ? -5.0
                          : row.tool == "burr6"         ? 1.5 + 1.2 * wave
                                                        : 4.0 + 2.0 * wave;
  const double lean = 0.2 * std::sin(2.0 * t_s);
  return {{x_mm, y_mm, height - depth_mm},
          Quat(std::cos(0.5 * lean), std::sin(0.5 * lean), 0.0, 0.0)};
}

Error cancelled() {
  return {code::kCancelled, "The measurement was cancelled", "measure haptics", ""};
}

Status check(const HapticsOptions& options) {
  const auto bad = [](const char* what, const char* where) {
    return Error{code::kBadArgument, what, where, ""};
  };
  if (options.ticks < 100 || options.ticks > 1'000'000) {
    return bad("A row takes 100 to 1,000,000 ticks", "ticks");
  }
  if (options.grids.empty() || options.boxes_mm.empty()) {
    return bad("There must be a grid and a box to measure in", "grids, boxes_mm");
  }
  for (int grid : options.grids) {
    if (grid < 32 || grid > 1024) return bad("A grid has 32 to 1024 voxels along an edge", "grids");
  }
  for (double box_mm : options.boxes_mm) {
    if (!(box_mm >= 49.2 && box_mm <= 300.0)) {
      return bad("A box has edges of 49.2 to 300 mm", "boxes_mm");
    }
  }
  return {};
}

// All rows of one box; the grids take turns, so that what else the machine does meets them alike.
Status measureBox(const HapticsOptions& options, double box_mm,
                  const std::filesystem::path& journal_folder, const Progress& progress,
                  HapticsMeasurement& out) {
  std::vector<std::unique_ptr<Grid>> grids;
  for (int size : options.grids) {
    grids.push_back(std::make_unique<Grid>(shellTop(size, box_mm)));
    if (progress.cancelled()) return cancelled();
  }
  const std::size_t rows =
      options.boxes_mm.size() * grids.size() * std::size(kTools) * 2 * std::size(kPhases);
  for (const char* tool : kTools) {
    for (int arms : {1, 2}) {
      for (TouchPhase phase : kPhases) {
        for (std::size_t g = 0; g < grids.size(); ++g) {
          HapticsRow row;
          row.tool = tool;
          row.arms = arms;
          row.grid = options.grids[g];
          row.box_mm = box_mm;
          row.phase = phase;
          progress.at((1.0 - kSlidingShare) * double(out.rows.size()) / double(rows),
                      row.tool + " " + touchPhaseName(phase));
          Result<HapticsRow> measured =
              measureHapticsRow(row, *grids[g], options.ticks, journal_folder, progress);
          if (!measured) return measured.error();
          out.rows.push_back(*measured);
        }
      }
    }
  }
  return {};
}

std::string toCsv(const HapticsMeasurement& measurement) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "tool,arms,grid,box_mm,phase,mean_ns,median_ns,p99_ns,p999_ns,max_ns,removed_mm3_per_s,"
          "ticks\n";
  for (const HapticsRow& row : measurement.rows) {
    text << row.tool << ',' << row.arms << ',' << row.grid << ',' << row.box_mm << ','
         << touchPhaseName(row.phase) << std::fixed << std::setprecision(0);
    for (double ns : {row.mean_ns, row.median_ns, row.p99_ns, row.p999_ns, row.max_ns})
      text << ',' << ns;
    text << std::setprecision(3) << ',' << row.removed_mm3_per_s << std::defaultfloat << ','
         << row.ticks << '\n';
  }
  return text.str();
}

const HapticsRow* find(const std::vector<HapticsRow>& rows, const char* tool, int grid,
                       double box_mm, TouchPhase phase) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const HapticsRow& r) {
    return r.tool == tool && r.arms == 2 && r.grid == grid && r.box_mm == box_mm &&
           r.phase == phase;
  });
  return found == rows.end() ? nullptr : &*found;
}

}  // namespace

const char* touchPhaseName(TouchPhase phase) {
  switch (phase) {
    case TouchPhase::free:
      return "free";
    case TouchPhase::contact:
      return "contact";
    case TouchPhase::removal:
      break;
  }
  return "removal";
}

bool isOfItsPhase(const HapticsRow& row) {
  if (row.phase == TouchPhase::free) return row.touched == 0 && row.removed_mm3_per_s == 0.0;
  if (row.phase == TouchPhase::removal) return row.removed_mm3_per_s > 0.0;
  return row.touched == row.ran && row.ran > 0 && row.removed_mm3_per_s == 0.0;
}

Result<HapticsRow> measureHapticsRow(HapticsRow row, Grid& grid, int ticks,
                                     const std::filesystem::path& journal_folder,
                                     const Progress& progress) {
  Result<std::unique_ptr<JournalFile>> journal_file = JournalFile::create(journal_folder);
  if (!journal_file) return journal_file.error();
  const EllipsoidShell shell;
  std::vector<std::pair<std::uint32_t, std::int16_t>> changed;
  std::vector<double> ns;
  ns.reserve(std::size_t(ticks));
  std::size_t removed = 0;
  Status served;
  {
    HapticCore core(parametersOf(row), *grid.takeWriter());
    TickInput input;
    TickRecord record;
    for (int n = -kLeadInTicks; n < ticks && served && !progress.cancelled(); ++n) {
      for (int arm = 0; arm < row.arms; ++arm) {
        Pose pose_mm = strokePose_mm(shell, row, arm, std::max(0, n) * kPeriod_s);
        pose_mm.position.z += kLeadIn_mm * std::max(0, -n) / kLeadInTicks;
        ArmSample& sample = input.arms[std::size_t(arm)];
        sample.position_m = 0.001 * pose_mm.position;
        sample.orientation = pose_mm.orientation;
      }
      input.journal = core.journalState();
      const auto begin = std::chrono::steady_clock::now();
      core.tick(input, nullptr, 0, record);
      const std::chrono::duration<double, std::nano> took =
          std::chrono::steady_clock::now() - begin;
      ++input.tick;

      bool touching = false;
      for (int arm = 0; arm < row.arms; ++arm) {
        const ArmRecord& moved = record.arms[std::size_t(arm)];
        touching = touching || moved.points_in_tissue > 0 || (moved.tool_state & kToolHeld);
      }
      for (const CarveRecord& carve : core.carves()) {
        changed.emplace_back(carve.voxel, carve.old_hu);
      }
      if (n % kServeEvery == 0) served = (*journal_file)->service(core.journal());
      if (n < 0) continue;
      row.touched += touching;
      const bool counts = row.phase == TouchPhase::free || touching || !core.carves().empty();
      if (counts) ns.push_back(took.count());
      removed += core.carves().size();
    }
  }
  Grid::Writer writer = *grid.takeWriter();
  for (const auto& [voxel, hu] : changed) writer.store(voxel, hu);
  if (!served) return served.error();
  if (progress.cancelled()) return cancelled();
  row.ran = std::size_t(ticks);
  const double seconds = double(ns.size()) * kPeriod_s;
  if (seconds > 0.0) {
    row.removed_mm3_per_s = double(removed) * grid.geometry().voxelVolume_mm3() / seconds;
  }
  return summarizeTicks(std::move(ns), row);
}

HapticsRow summarizeTicks(std::vector<double> ns, HapticsRow row) {
  std::sort(ns.begin(), ns.end());
  row.ticks = ns.size();
  row.mean_ns = meanOf(ns);
  row.median_ns = quantile(ns, 500);
  row.p99_ns = quantile(ns, 990);
  row.p999_ns = quantile(ns, 999);
  row.max_ns = quantile(ns, 1000);
  return row;
}

std::vector<HapticsBar> hapticsBars(const HapticsMeasurement& m) {
  std::vector<HapticsBar> bars;
  const HapticsRow* fine = find(m.rows, "burr6", 512, 49.2, TouchPhase::removal);
  const HapticsRow* coarse = find(m.rows, "burr6", 256, 49.2, TouchPhase::removal);
  const HapticsRow* blade = find(m.rows, "blade64", 512, 200.0, TouchPhase::contact);
  if (fine) {
    bars.push_back(
        {"burr6, 2 arms, 512^3 at 49.2 mm, removal: mean [us]", fine->mean_ns / 1e3, 20.0});
    bars.push_back(
        {"burr6, 2 arms, 512^3 at 49.2 mm, removal: p99.9 [us]", fine->p999_ns / 1e3, 150.0});
  }
  if (fine && coarse && coarse->mean_ns > 0.0) {
    bars.push_back({"the same mean against 256^3", fine->mean_ns / coarse->mean_ns, 1.5});
  }
  if (blade) {
    bars.push_back(
        {"blade64, 2 arms, 512^3 at 200 mm, contact: mean [us]", blade->mean_ns / 1e3, 5.0});
  }
  bars.push_back(
      {"direction of the push: median error [deg]", m.sliding.direction_median_deg, 3.0});
  bars.push_back({"direction of the push: p99 error [deg]", m.sliding.direction_p99_deg, 8.0});
  bars.push_back({"sliding: p99 step of force [% of its mean]", m.sliding.step_p99_percent, 3.0});
  const auto strays = std::count_if(m.rows.begin(), m.rows.end(),
                                    [](const HapticsRow& row) { return !isOfItsPhase(row); });
  bars.push_back({"rows that did not do what their phase says", double(strays), 0.0});
  return bars;
}

Result<HapticsMeasurement> measureHaptics(const HapticsOptions& options,
                                          const std::filesystem::path& out,
                                          const Progress& progress) {
  if (Status good = check(options); !good) return good.error();
  if (!out.empty()) {
    if (Status made = makeFolder(out); !made) return made.error();
  }
  const Result<std::filesystem::path> journal_folder = out.empty() ? temporaryFolder() : out;
  if (!journal_folder) return journal_folder.error();
  HapticsMeasurement result;
  for (double box_mm : options.boxes_mm) {
    const Status measured = measureBox(options, box_mm, *journal_folder, progress, result);
    if (!measured) return measured.error();
  }
  Result<SlidingMeasurement> sliding =
      measureSliding(options.sliding, progress, 1.0 - kSlidingShare, 1.0);
  if (!sliding) return sliding.error();
  result.sliding = *sliding;
  if (!out.empty()) {
    if (Status written = writeTextFile(out / "haptics.csv", toCsv(result)); !written) {
      return written.error();
    }
  }
  progress.at(1.0, "done");
  return result;
}

Json toJson(const HapticsMeasurement& measurement) {
  Json rows = Json::array(), bars = Json::array();
  for (const HapticsRow& row : measurement.rows) {
    rows.push_back({{"tool", row.tool},
                    {"arms", row.arms},
                    {"grid", row.grid},
                    {"box_mm", row.box_mm},
                    {"phase", touchPhaseName(row.phase)},
                    {"ns",
                     {{"mean", row.mean_ns},
                      {"median", row.median_ns},
                      {"p99", row.p99_ns},
                      {"p999", row.p999_ns},
                      {"max", row.max_ns}}},
                    {"removed_mm3_per_s", row.removed_mm3_per_s},
                    {"ticks", row.ticks}});
  }
  for (const HapticsBar& bar : hapticsBars(measurement)) {
    bars.push_back(
        {{"name", bar.name}, {"value", bar.value}, {"limit", bar.limit}, {"pass", bar.pass()}});
  }
  const SlidingMeasurement& s = measurement.sliding;
  return {
      {"rows", rows},
      {"direction_error_deg", {{"median", s.direction_median_deg}, {"p99", s.direction_p99_deg}}},
      {"sliding_force_step_percent_p99", s.step_p99_percent},
      {"depth_error_percent", s.depth_error_percent},
      {"bars", bars}};
}

std::string toText(const HapticsMeasurement& measurement) {
  std::string text =
      "a tick of all arms [us]                   mean    median      99 %    99.9 %       max     "
      "mm3/s\n";
  char line[200];
  for (const HapticsRow& row : measurement.rows) {
    std::snprintf(line, sizeof line,
                  "%-8s %d arm%s %4d^3 %5.1f mm %-7s %9.2f %9.2f %9.2f %9.2f %9.1f %9.2f\n",
                  row.tool.c_str(), row.arms, row.arms == 1 ? " " : "s", row.grid, row.box_mm,
                  touchPhaseName(row.phase), row.mean_ns / 1e3, row.median_ns / 1e3,
                  row.p99_ns / 1e3, row.p999_ns / 1e3, row.max_ns / 1e3, row.removed_mm3_per_s);
    text += line;
    if (isOfItsPhase(row)) continue;
    std::snprintf(line, sizeof line,
                  "  ... which is not of its phase: it touched in %zu of %zu ticks\n", row.touched,
                  row.ran);
    text += line;
  }
  const SlidingMeasurement& s = measurement.sliding;
  std::snprintf(line, sizeof line,
                "sliding: direction off by %.2f deg (median), %.2f (99 %%); step of force %.2f %% "
                "(99 %%); depth %+.2f %%\n",
                s.direction_median_deg, s.direction_p99_deg, s.step_p99_percent,
                s.depth_error_percent);
  text += line;
  for (const HapticsBar& bar : hapticsBars(measurement)) {
    std::snprintf(line, sizeof line, "%-58s %9.2f  at most %6.2f  %s\n", bar.name.c_str(),
                  bar.value, bar.limit, bar.pass() ? "pass" : "FAIL");
    text += line;
  }
  return text;
}

}  // namespace trephine
