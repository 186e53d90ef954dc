#include "lab/stability/stability_sets.h"

#include <algorithm>
#include <cstdio>

#include "base/codes.h"
#include "base/range.h"
#include "exercise/names.h"
#include "machine/common/on_all_processors.h"

namespace trephine {

namespace {

constexpr double kLasting_s = 30.0;
constexpr double kMoving_s = 5.0;

// One way in which the cells of a set are run.
struct Variation {
  std::string name;
  CellConditions conditions;
  std::optional<Impedance> hand = {};  // in place of the cell's
  int more_delay = 0;                  // of the arm itself
  bool counts = true;                  // in the total
};

std::vector<Variation> variationsOf(StabilitySet set, std::optional<double> seconds) {
  std::vector<Variation> all;
  CellConditions plain;
  plain.seconds = seconds.value_or(kCellDuration_s);
  if (set == StabilitySet::lasting) {
    plain.seconds = seconds.value_or(kLasting_s);
    all.push_back({plainNumber(plain.seconds) + " s", plain});
  } else if (set == StabilitySet::moving) {
    plain.seconds = seconds.value_or(kMoving_s);
    plain.moving = true;
    all.push_back({"4 mm at 1 Hz", plain});
  } else if (set == StabilitySet::hands) {
    for (double b : {1.0, 2.0, 5.0, 10.0, 0.0}) {
      for (double k : {50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0}) {
        all.push_back(
            {"k " + plainNumber(k) + " b " + plainNumber(b), plain, Impedance{b, k}, 0, b > 0.0});
      }
    }
  } else if (set == StabilitySet::claims) {
    for (double times : {0.5, 1.5, 2.0, 5.0}) {
      CellConditions claimed = plain;
      claimed.mass_claimed = times;
      all.push_back({"mass x " + plainNumber(times), claimed});
    }
    // Of an arm that has one sample more than the cell, so that there is one less to claim.
    CellConditions less = plain, more = plain, exact = plain;
    less.delay_claimed_more = -1;
    all.push_back({"one sample more than claimed", less, {}, 1});
    more.delay_claimed_more = 1;
    all.push_back({"one sample less than claimed", more});
    exact.encoder_claimed_exact = true;
    all.push_back({"encoder claimed exact", exact});
  }
  return all;
}

struct Run {
  StabilityCell cell;
  std::size_t variation = 0;
  CellResult result;
  bool also_ideal = false;
};

// Whether the variation says anything of the cell.
bool applies(const Variation& variation, const StabilityCell& cell) {
  if (variation.conditions.moving && cell.hand.stiffness <= 0.0) return false;  // nothing moves it
  return !variation.conditions.encoder_claimed_exact || cell.encoder_m > 0.0;
}

void count(const Run& run, SetRow& row) {
  ++row.cells;
  row.not_as_stated += run.result.not_as_stated;
  if (run.also_ideal) {
    ++row.also_ideal;
    return;
  }
  row.unstable += !run.result.stable;
  row.energy_out_J_max = std::max(row.energy_out_J_max, run.result.energy_out_J);
  if (run.result.oscillation_m > row.cycle_m_max) {
    row.cycle_m_max = run.result.oscillation_m;
    row.cycle_Hz = run.result.cycle_Hz;
  }
}

Json rowJson(const SetRow& row) {
  return {{"cells", row.cells},
          {"unstable", row.unstable},
          {"also_ideal", row.also_ideal},
          {"energy_out_mJ_max", 1e3 * row.energy_out_J_max},
          {"cycle_um_max", 1e6 * row.cycle_m_max},
          {"cycle_Hz", row.cycle_Hz},
          {"not_as_stated", row.not_as_stated}};
}

std::string rowText(const char* indent, const SetRow& row) {
  char line[260];
  std::snprintf(
      line, sizeof(line),
      "%s%-30s %5zu of %5zu unstable (%.1f %%), %zu as the ideal law; at most %.3f mJ given "
      "out, cycle %.0f um at %.0f Hz; arm not as stated in %zu\n",
      indent, row.name.c_str(), row.unstable, row.cells,
      row.cells > 0 ? 100.0 * double(row.unstable) / double(row.cells) : 0.0, row.also_ideal,
      1e3 * row.energy_out_J_max, 1e6 * row.cycle_m_max, row.cycle_Hz, row.not_as_stated);
  return line;
}

}  // namespace

Result<std::vector<StabilitySet>> readStabilitySets(const std::string& names) {
  std::vector<StabilitySet> sets;
  for (std::size_t begin = 0; begin <= names.size();) {
    const std::size_t end = std::min(names.find(',', begin), names.size());
    const std::string name = names.substr(begin, end - begin);
    const auto set = kindOf(kStabilitySetNames, name);
    if (!set) {
      return Error{code::kBadArgument, "There is no set '" + name + "'", "--sets",
                   choices(kStabilitySetNames)};
    }
    if (std::find(sets.begin(), sets.end(), *set) == sets.end()) sets.push_back(*set);
    begin = end + 1;
  }
  return sets;
}

std::vector<StabilityCell> representativeCells() {
  const std::vector<StabilityCell> grid = fullGrid();
  std::vector<StabilityCell> cells;
  for (std::size_t i = 0; i < 304; ++i) cells.push_back(grid[i * 2252 % grid.size()]);
  return cells;
}

Result<SetFigures> measureStabilitySet(StabilitySet set, const std::vector<StabilityCell>& cells,
                                       std::optional<double> seconds, const Progress& progress) {
  const std::vector<Variation> variations = variationsOf(set, seconds);
  std::vector<Run> runs;
  for (std::size_t v = 0; v < variations.size(); ++v) {
    for (StabilityCell cell : cells) {
      if (!applies(variations[v], cell)) continue;
      if (variations[v].hand) cell.hand = *variations[v].hand;
      cell.delay_samples =
          std::min(cell.delay_samples + variations[v].more_delay, kDelaySamples.high);
      runs.push_back({cell, v, {}, false});
    }
  }
  const bool finished = onAllProcessors(runs.size(), "Stability", progress, [&](std::size_t i) {
    Run& run = runs[i];
    const CellConditions& conditions = variations[run.variation].conditions;
    run.result = runCell(run.cell, CellDriver::bounded, 1.0, conditions);
    if (run.result.stable) return;
    const CellResult ideal = runCell(run.cell, CellDriver::ideal, 1.0, conditions);
    run.also_ideal = faultsOf(run.cell, run.result).allIn(faultsOf(run.cell, ideal));
  });
  if (!finished) return Error{code::kCancelled, "The measurement was cancelled", "", ""};

  SetFigures figures;
  figures.total.name = "all";
  for (const Variation& variation : variations) figures.rows.emplace_back().name = variation.name;
  for (const Run& run : runs) {
    count(run, figures.rows[run.variation]);
    if (variations[run.variation].counts) count(run, figures.total);
  }
  return figures;
}

Json toJson(const SetFigures& figures) {
  Json json = rowJson(figures.total);
  json["rows"] = Json::array();
  for (const SetRow& row : figures.rows) {
    Json item{{"name", row.name}};
    item.update(rowJson(row));
    json["rows"].push_back(item);
  }
  return json;
}

std::string toText(const std::string& name, const SetFigures& figures) {
  std::string text = name + "\n";
  if (figures.rows.size() > 1) {
    for (const SetRow& row : figures.rows) text += rowText("  ", row);
  }
  return text + rowText("  ", figures.total);
}

}  // namespace trephine
