#include "lab/touch/rest_measurement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/codes.h"
#include "base/formatted.h"
#include "haptics/unseen_energy.h"
#include "lab/touch/rest_places.h"
#include "machine/common/on_all_processors.h"

namespace trephine {

namespace {

constexpr double kApproach_m_s = 0.02, kSettle_s = 3.0, kSettleAtEdge_s = 8.0;
constexpr double kSwing_s = 10.0, kSwing_Hz = 1.0, kCreep_m_s = 2e-4;
constexpr double kIdealPeriod_s = 2e-4;
constexpr double kStill_m = 20e-6, kStill_J = 2e-4, kGrave_J = 5e-4;
constexpr double kAbove2Hz_s = 0.5, kBesideSwing_s = 0.1;  // of the mean that is taken off

bool isAtRest(HoldKind kind) {
  return kind == HoldKind::rest || kind == HoldKind::edge;
}

// Peak to peak and frequency of what is left along the axis that has most of it.
void judgeMotion(const std::array<std::vector<double>, 3>& x, HoldKind kind, double period_s,
                 HoldResult& result) {
  const double mean_s = isAtRest(kind) ? kAbove2Hz_s : kBesideSwing_s;
  const auto half = std::size_t(std::lround(0.5 * mean_s / period_s));
  for (const std::vector<double>& axis : x) {
    std::vector<double> left = lessItsMean(axis, half);
    if (!isAtRest(kind)) left = lessItsMean(left, half);
    const std::size_t end = 2 * half;  // where the mean is narrower
    if (left.size() <= 2 * end + 1) continue;
    const auto first = left.begin() + std::ptrdiff_t(end), last = left.end() - std::ptrdiff_t(end);
    const auto [low, high] = std::minmax_element(first, last);
    if (*high - *low <= result.cycle_m) continue;
    result.cycle_m = *high - *low;
    std::size_t upwards = 0;
    for (auto at = first + 1; at != last; ++at) upwards += at[-1] < 0.0 && *at >= 0.0;
    result.cycle_Hz = double(upwards) / (double(last - first) * period_s);
  }
}

// A unit vector across another.
Vec3 acrossOf(const Vec3& v) {
  const Vec3 other = std::abs(v.x) < std::abs(v.y) ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  return glm::normalize(glm::cross(v, other));
}

std::string kindName(HoldKind kind) {
  constexpr const char* kNames[] = {"rest", "swing", "creep", "edge"};
  return kNames[std::size_t(kind)];
}

}  // namespace

HoldFaults faultsOf(HoldKind kind, const HoldResult& r, double encoder_m) {
  // Not a number is a fault.
  if (isAtRest(kind)) {
    return {!(r.cycle_m <= std::max(kStill_m, encoder_m)), !(r.energy_out_J <= kStill_J)};
  }
  return {!(r.cycle_m <= std::max(kStill_m, 2.0 * encoder_m)),
          !(r.energy_out_J <= unseenEnergy_J(encoder_m))};
}

bool isGrave(HoldKind kind, const HoldResult& r, double encoder_m) {
  return isAtRest(kind) &&
         !(r.cycle_m <= std::max(kStill_m, 2.0 * encoder_m) && r.energy_out_J <= kGrave_J);
}

std::vector<HoldResult> hold(HapticParameters parameters, const Volume& volume,
                             std::vector<RigArm> arms, const std::vector<HoldPath>& paths,
                             HoldKind kind, double seconds, bool ideal,
                             const std::shared_ptr<const LabelMap>& labels) {
  if (ideal) {
    parameters.period_s = kIdealPeriod_s;
    parameters.controller = ControllerKind::off;
    for (ArmParameters& arm : parameters.arms) arm.dynamics.encoder_step_m = 0.0;
    for (RigArm& arm : arms) arm.encoder_m = 0.0;
  }
  const double T = parameters.period_s;
  TouchRig rig(parameters, volume, arms, labels);
  double way_m = 0.0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    rig.place(i, paths[i].start_m);
    way_m = std::max(way_m, glm::length(paths[i].held_m - paths[i].start_m));
  }
  const double arrived_s = way_m / kApproach_m_s,
               judged_s = arrived_s + (kind == HoldKind::edge ? kSettleAtEdge_s : kSettle_s);
  const auto ticks = std::size_t(std::llround((judged_s + seconds) / T));
  std::vector<HoldResult> results(paths.size());
  std::vector<std::array<std::vector<double>, 3>> x(paths.size());
  std::vector<double> sent_N(paths.size()), demanded_N(paths.size());
  constexpr double kTurn = 6.283185307179586 * kSwing_Hz;
  for (std::size_t n = 0; n < ticks; ++n) {
    const double t = double(n + 1) * T;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const HoldPath& p = paths[i];
      Vec3 at_m = p.start_m + std::min(1.0, t / arrived_s) * (p.held_m - p.start_m);
      if (kind == HoldKind::swing && t > arrived_s) {
        at_m += std::sin(kTurn * (t - arrived_s)) * p.swing_m;
      }
      if (kind == HoldKind::creep && t > arrived_s) {
        at_m += (kCreep_m_s * (t - arrived_s)) * acrossOf(p.swing_m);
      }
      rig.moveHand(i, at_m);
    }
    const TickRecord& record = rig.step();
    if (double(n) * T < judged_s) {
      if (kind != HoldKind::edge) continue;
      for (std::size_t i = 0; i < paths.size(); ++i) rig.countTrueEnergyAnew(i);
      continue;
    }
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const ArmRecord& arm = record.arms[i];
      results[i].touched = results[i].touched || arm.demanded_N != Vec3(0.0);
      results[i].waited = results[i].waited || (arm.tool_state & kToolWaits);
      results[i].removed_voxels += std::uint64_t(arm.removed_voxels);
      sent_N[i] += glm::length(arm.sent_N);
      demanded_N[i] += glm::length(arm.demanded_N);
      for (int axis = 0; axis < 3; ++axis) {
        x[i][std::size_t(axis)].push_back(rig.position_m(i)[axis]);
      }
    }
  }
  for (std::size_t i = 0; i < paths.size(); ++i) {
    results[i].energy_out_J = kind == HoldKind::rest ? rig.energyOut_J(i) : rig.trueEnergyOut_J(i);
    if (demanded_N[i] > 0.0) results[i].shown = sent_N[i] / demanded_N[i];
    results[i].demanded_N = demanded_N[i] * T / seconds;
    judgeMotion(x[i], kind, T, results[i]);
  }
  return results;
}

Result<RestFigures> measureRest(std::optional<double> seconds, const Progress& progress) {
  Result<std::vector<HoldCell>> cells = restPlaces(Progress(progress, 0.0, 0.1));
  if (!cells) return cells.error();
  RestFigures figures;
  figures.seconds = seconds.value_or(kRest_s);
  struct Run {
    const HoldCell* cell;
    HoldKind kind;
  };
  std::vector<Run> runs;
  for (const HoldCell& cell : *cells) {
    for (const HoldKind kind : cell.kinds) runs.push_back({&cell, kind});
  }
  std::vector<std::vector<RestRow>> rows(runs.size());
  const Progress part(progress, 0.1, 1.0);
  const bool finished = onAllProcessors(rows.size(), "Rest", part, [&](std::size_t n) {
    const HoldCell& cell = *runs[n].cell;
    const HoldKind kind = runs[n].kind;
    const double s = isAtRest(kind) ? figures.seconds : std::min(kSwing_s, figures.seconds);
    const auto run = [&](bool ideal) {
      return hold(cell.parameters, *cell.volume, cell.rig, cell.paths, kind, s, ideal,
                  cell.labels);
    };
    const std::vector<HoldResult> held = run(false);
    for (std::size_t i = 0; i < held.size(); ++i) {
      RestRow row{cell.exercise, cell.arms[i], cell.tools[i],        cell.place,
                  kind,          held[i],      cell.rig[i].encoder_m};
      row.unstable = faultsOf(kind, held[i], row.encoder_m).any();
      rows[n].push_back(std::move(row));
    }
    const bool any = std::any_of(rows[n].begin(), rows[n].end(),
                                 [](const RestRow& row) { return row.unstable; });
    if (!any) return;
    const std::vector<HoldResult> ideal = run(true);
    for (std::size_t i = 0; i < held.size(); ++i) {
      RestRow& row = rows[n][i];
      row.also_ideal =
          row.unstable &&
          faultsOf(kind, held[i], row.encoder_m).allIn(faultsOf(kind, ideal[i], row.encoder_m));
      row.unstable = row.unstable && !row.also_ideal;
    }
  });
  if (!finished) return Error{code::kCancelled, "The measurement was cancelled", "", ""};
  for (std::vector<RestRow>& some : rows) {
    std::move(some.begin(), some.end(), std::back_inserter(figures.rows));
  }
  return figures;
}

namespace {

struct RestSum {
  std::string name;
  std::size_t cells = 0, unstable = 0, also_ideal = 0, beyond = 0, cutting = 0, apart = 0;
  double energy_out_J_max = 0.0, cycle_m_max = 0.0, cycle_Hz = 0.0, least_shown = 1.0;

  void add(const RestRow& row) {
    ++cells;
    cutting += row.result.removed_voxels > 0;
    apart += row.result.waited || !row.result.touched;
    if (row.result.touched && !row.result.waited && row.result.demanded_N >= kWorthShowing_N) {
      least_shown = std::min(least_shown, row.result.shown);
    }
    if (row.also_ideal) {
      ++also_ideal;
      return;
    }
    unstable += row.unstable;
    beyond += row.unstable && isGrave(row.kind, row.result, row.encoder_m);
    energy_out_J_max = std::max(energy_out_J_max, row.result.energy_out_J);
    if (row.result.cycle_m > cycle_m_max) {
      cycle_m_max = row.result.cycle_m;
      cycle_Hz = row.result.cycle_Hz;
    }
  }
};

// Exercises and blocks, at rest, swung and creeping; scaled blocks; edges.
std::size_t sumOf(const RestRow& row) {
  if (row.kind == HoldKind::edge) return row.exercise.rfind("scaled", 0) == 0 ? 6 : 7;
  return (row.exercise.rfind("block", 0) == 0 ? 3 : 0) + std::size_t(row.kind);
}

// These, and all.
std::vector<RestSum> sumsOf(const RestFigures& figures) {
  std::vector<RestSum> sums(9);
  const std::string minute = plainNumber(figures.seconds) + " s";
  const std::string names[] = {"scenes at rest, " + minute, "scenes swung",     "scenes creeping",
                               "blocks at rest, " + minute, "blocks swung",     "blocks creeping",
                               "scaled blocks, " + minute,  "edges, " + minute, "all"};
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i].name = names[i];
  for (const RestRow& row : figures.rows) {
    sums[sumOf(row)].add(row);
    sums.back().add(row);
  }
  return sums;
}

Json sumJson(const RestSum& s) {
  return {{"cells", s.cells},
          {"unstable", s.unstable},
          {"also_ideal", s.also_ideal},
          {"energy_out_mJ_max", 1e3 * s.energy_out_J_max},
          {"cycle_um_max", 1e6 * s.cycle_m_max},
          {"cycle_Hz", s.cycle_Hz},
          {"least_shown", s.least_shown},
          {"beyond_accepted", s.beyond},
          {"cutting", s.cutting},
          {"felt_nothing", s.apart}};
}

}  // namespace

Json toJson(const RestFigures& figures) {
  const std::vector<RestSum> sums = sumsOf(figures);
  Json json = sumJson(sums.back());
  json["kinds"] = Json::array();
  for (std::size_t i = 0; i + 1 < sums.size(); ++i) {
    Json kind{{"name", sums[i].name}};
    kind.update(sumJson(sums[i]));
    json["kinds"].push_back(kind);
  }
  json["rows"] = Json::array();
  for (const RestRow& row : figures.rows) {
    json["rows"].push_back({{"scene", row.exercise},
                            {"arm", row.arm},
                            {"tool", row.tool},
                            {"place", row.place},
                            {"kind", kindName(row.kind)},
                            {"cycle_um", 1e6 * row.result.cycle_m},
                            {"cycle_Hz", row.result.cycle_Hz},
                            {"energy_out_mJ", 1e3 * row.result.energy_out_J},
                            {"shown", row.result.shown},
                            {"demanded_N", row.result.demanded_N},
                            {"unstable", row.unstable},
                            {"also_ideal", row.also_ideal},
                            {"cuts", row.result.removed_voxels > 0},
                            {"felt", row.result.touched && !row.result.waited}});
  }
  return json;
}

std::string toText(const RestFigures& figures) {
  std::string text = "rest\n";
  for (const RestSum& s : sumsOf(figures)) {
    text += formatted(
        "  %-30s %5zu of %5zu unstable (%.1f %%), %zu as the ideal law, %zu beyond what is "
        "accepted; at most %.3f mJ given out, cycle %.0f um at %.0f Hz; at least %.2f of the "
        "demand sent; cutting in %zu, nothing felt in %zu\n",
        s.name.c_str(), s.unstable, s.cells,
        s.cells > 0 ? 100.0 * double(s.unstable) / double(s.cells) : 0.0, s.also_ideal, s.beyond,
        1e3 * s.energy_out_J_max, 1e6 * s.cycle_m_max, s.cycle_Hz, s.least_shown, s.cutting,
        s.apart);
  }
  for (const RestRow& row : figures.rows) {
    if (!row.unstable) continue;
    text +=
        formatted("    %s: %s arm, %s, %s, %s: %.0f um at %.0f Hz, %.3f mJ%s\n", row.exercise.c_str(),
                  row.arm.c_str(), row.tool.c_str(), row.place.c_str(), kindName(row.kind).c_str(),
                  1e6 * row.result.cycle_m, row.result.cycle_Hz, 1e3 * row.result.energy_out_J,
                  row.result.removed_voxels > 0 ? ", cutting" : "");
  }
  return text;
}

}  // namespace trephine
