#include "lab/stability/stability_measurement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <utility>

#include "base/codes.h"
#include "base/file.h"
#include "machine/common/on_all_processors.h"

namespace trephine {

namespace {

constexpr std::size_t kMostCells = 100'000;
constexpr double kFaithfulPoints = 0.01;

using ControllerColumn = CellResult JudgedCell::*;
constexpr std::array<std::pair<const char*, ControllerColumn>, 3> kColumns{
    {{"off", &JudgedCell::off}, {"seed", &JudgedCell::seed}, {"bounded", &JudgedCell::bounded}}};

StabilityCell readCell(JsonReader item) {
  StabilityCell cell;
  cell.mass_kg = item.number("mass_kg", {1e-3, 10.0});
  cell.period_s = item.number("period_s", {2e-5, 0.05});
  cell.delay_samples = item.number("delay_samples", kDelaySamples);
  cell.encoder_m = 1e-3 * item.number("encoder_mm", {0.0, 5.0});
  if (item.has("plant_damping")) cell.plant_damping = item.number("plant_damping", {0.0, 100.0});
  if (!item.raw("hand").is_null()) {
    JsonReader hand = item.object("hand");
    cell.hand = {hand.number("b", {0.0, 1e4}), hand.number("k", {0.0, 1e6})};
  }
  JsonReader tissue = item.object("tissue");
  cell.tissue = {tissue.number("b", {0.0, 1e12}), tissue.number("k", {0.0, 1e12})};
  return cell;
}

// The column's authority in a cell where it is asked.
std::optional<double> authority(const JudgedCell& cell, ControllerColumn column) {
  if (cell.reference.margin || !cell.reference.contact_rms_N) return {};
  return (cell.*column).contact_rms_N / *cell.reference.contact_rms_N;
}

JudgedCell judge(const StabilityCell& cell, double seconds) {
  CellConditions conditions;
  conditions.seconds = seconds;
  const auto run = [&](CellDriver driver) { return runCell(cell, driver, 1.0, conditions); };
  JudgedCell judged;
  judged.reference = referenceOf(cell, seconds);
  judged.off = judged.reference.off;
  judged.seed = run(CellDriver::seed);
  judged.bounded = run(CellDriver::bounded);
  judged.zero_force = run(CellDriver::zero_force);
  const auto reached = authority(judged, &JudgedCell::bounded);
  if (reached && *reached < 0.7) {
    judged.ideal_authority = run(CellDriver::ideal).contact_rms_N / *judged.reference.contact_rms_N;
  }
  return judged;
}

std::string instability(const StabilityCell& cell, const CellResult& r) {
  std::string parts;
  const auto add = [&](const char* part) {
    parts += (parts.empty() ? "" : ", ") + std::string(part);
  };
  if (r.oscillation_m > std::max(2e-5, 2.0 * cell.encoder_m)) add("it oscillates");
  if (r.step_N > 0.1) add("the force jumps");
  if (r.energy_out_J > unseenEnergy_J(cell)) add("energy is given out");
  return parts;
}

// What kept the rendered tissue below the demanded one.
std::string limitOf(const StabilityCell& cell) {
  const ArmDynamics arm{cell.mass_kg, cell.encoder_m, kCellForce_N,
                        cell.period_s * cell.delay_samples};
  const double rate_hz = 1.0 / cell.period_s;
  const Renderable most = renderable(arm, rate_hz, cell.delay_samples, {});
  ArmDynamics fine = arm;
  fine.encoder_step_m = 0.0;
  const Renderable without_encoder = renderable(fine, rate_hz, cell.delay_samples, {});
  if (cell.tissue.stiffness > most.k_max) {
    return without_encoder.k_max > 1.01 * most.k_max
               ? "k is bounded by the encoder's step and the lag of its estimate"
               : "k is bounded by mass and delay";
  }
  if (cell.tissue.damping > most.b_max) return "b is bounded by mass and delay";
  return "less is rendered than the bound: shaking was felt, or the estimate lags";
}

Json number(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json figuresJson(const BarFigures& f) {
  return {{"cells", f.cells},
          {"unstable", f.unstable},
          {"energy_out_mJ_max", 1e3 * f.energy_out_J_max}};
}

}  // namespace

Result<std::vector<StabilityCell>> readGrid(const std::filesystem::path& file) {
  Result<Json> json = readJsonFile(file);
  if (!json) return json.error();
  JsonReader reader(*json, file.string());
  std::vector<StabilityCell> cells;
  for (JsonReader& item : reader.objects("cells", kMostCells)) cells.push_back(readCell(item));
  if (reader.ok() && cells.empty()) reader.fail("cells", "There must be at least one cell");
  if (Status read = reader.finish(); !read) return read.error();
  return cells;
}

Result<StabilityMeasurement> measureStability(std::vector<StabilityCell> cells,
                                              const Progress& progress, double seconds) {
  StabilityMeasurement measurement{std::move(cells), {}};
  const std::size_t count = measurement.cells.size();
  measurement.judged.resize(count);
  const bool finished = onAllProcessors(count, "Stability", progress, [&](std::size_t i) {
    measurement.judged[i] = judge(measurement.cells[i], seconds);
  });
  if (!finished) return Error{code::kCancelled, "The measurement was cancelled", "", ""};
  return measurement;
}

bool BarFigures::accepted() const {
  const auto share = [](std::size_t part, std::size_t whole) {
    return whole == 0 ? 0.0 : double(part) / double(whole);
  };
  return share(unstable, cells) <= 0.01 && share(unfaithful, cells_with_margin) <= 0.10 &&
         share(below_0_5, authority_cells) <= 0.20;
}

BarFigures figuresOf(const StabilityMeasurement& measurement, ControllerColumn column) {
  BarFigures f;
  f.cells = measurement.cells.size();
  for (const JudgedCell& cell : measurement.judged) {
    const CellResult& r = cell.*column;
    f.unstable += !r.stable;
    f.energy_out_J_max = std::max(f.energy_out_J_max, r.energy_out_J);
    if (cell.reference.margin) {
      ++f.cells_with_margin;
      const double points = r.fidelity_error - cell.off.fidelity_error;
      f.worst_points = std::max(f.worst_points, 100.0 * points);
      f.unfaithful += points > kFaithfulPoints;
    } else if (const auto reached = authority(cell, column)) {
      ++f.authority_cells;
      f.below_0_7 += *reached < 0.7;
      f.below_0_5 += *reached < 0.5;
      f.lowest_authority = std::min(*reached, f.lowest_authority.value_or(*reached));
      if (column == &JudgedCell::bounded && cell.ideal_authority) {
        f.ideal_below_0_7 += *cell.ideal_authority < 0.7;
        f.ideal_below_0_5 += *reached < 0.5 && *cell.ideal_authority < 0.5;
      }
    } else {
      ++f.no_reference;
    }
  }
  return f;
}

std::vector<MissedBar> missedBars(const StabilityMeasurement& measurement) {
  std::vector<MissedBar> missed;
  for (std::size_t i = 0; i < measurement.cells.size(); ++i) {
    const StabilityCell& cell = measurement.cells[i];
    const JudgedCell& judged = measurement.judged[i];
    const CellResult& r = judged.bounded;
    if (!r.stable) missed.push_back({i, "stable", r.step_N, instability(cell, r)});
    const double points = r.fidelity_error - judged.off.fidelity_error;
    if (judged.reference.margin && points > kFaithfulPoints) {
      missed.push_back({i, "faithful", 100.0 * points, limitOf(cell)});
    }
    const auto reached = authority(judged, &JudgedCell::bounded);
    if (reached && *reached < 0.7) {
      const double threshold = *reached < 0.5 ? 0.5 : 0.7;
      missed.push_back({i, "authority", *reached,
                        *judged.ideal_authority < threshold
                            ? "the continuous law on a perfect arm stays below as well"
                            : limitOf(cell)});
    }
  }
  return missed;
}

std::vector<MapCell> mapCells(const StabilityMeasurement& measurement) {
  std::vector<MapCell> cells;
  for (const auto& [name, column] : kColumns) {
    for (std::size_t i = 0; i < measurement.cells.size(); ++i) {
      const StabilityCell& c = measurement.cells[i];
      cells.push_back({name, c.mass_kg, c.period_s, c.delay_samples, c.encoder_m, c.hand.stiffness,
                       c.hand.damping, c.tissue.damping, c.tissue.stiffness,
                       (measurement.judged[i].*column).stable});
    }
  }
  return cells;
}

Json toJson(const StabilityMeasurement& measurement) {
  Json controllers = Json::object(), per_cell = Json::array(), missed = Json::array();
  for (const auto& [name, column] : kColumns) {
    controllers[name] = figuresJson(figuresOf(measurement, column));
  }
  const BarFigures bounded = figuresOf(measurement, &JudgedCell::bounded);
  const BarFigures zero = figuresOf(measurement, &JudgedCell::zero_force);
  for (std::size_t i = 0; i < measurement.cells.size(); ++i) {
    const JudgedCell& cell = measurement.judged[i];
    for (const auto& [name, column] : kColumns) {
      const CellResult& r = cell.*column;
      per_cell.push_back({{"cell", i},
                          {"controller", name},
                          {"oscillation_mm", 1e3 * r.oscillation_m},
                          {"step_N", r.step_N},
                          {"energy_out_mJ", 1e3 * r.energy_out_J},
                          {"fidelity_error", r.fidelity_error},
                          {"authority", number(authority(cell, column))},
                          {"stable", r.stable},
                          {"margin", cell.reference.margin}});
    }
  }
  for (const MissedBar& m : missedBars(measurement)) {
    missed.push_back({{"cell", m.cell}, {"bar", m.bar}, {"value", m.value}, {"cause", m.cause}});
  }
  return {{"controllers", controllers},
          {"faithful",
           {{"cells_with_margin", bounded.cells_with_margin},
            {"unfaithful", bounded.unfaithful},
            {"worst_percent_points", bounded.worst_points}}},
          {"authority",
           {{"cells", bounded.authority_cells},
            {"no_reference", bounded.no_reference},
            {"below_0_7", bounded.below_0_7},
            {"below_0_5", bounded.below_0_5},
            {"lowest", number(bounded.lowest_authority)},
            {"ideal_below_0_7", bounded.ideal_below_0_7},
            {"ideal_below_0_5", bounded.ideal_below_0_5}}},
          {"accepted", bounded.accepted()},
          {"zero_force",
           {{"unstable", zero.unstable},
            {"unfaithful", zero.unfaithful},
            {"below_0_5", zero.below_0_5},
            {"accepted", zero.accepted()}}},
          {"missed", missed},
          {"per_cell", per_cell}};
}

std::string toText(const StabilityMeasurement& measurement) {
  char line[200];
  std::string text;
  const auto add = [&](const char* format, auto... values) {
    std::snprintf(line, sizeof(line), format, values...);
    text += line;
  };
  add("%zu cells\n", measurement.cells.size());
  for (const auto& [name, column] : kColumns) {
    const BarFigures f = figuresOf(measurement, column);
    add("  %-8s %5zu unstable, at most %.3f mJ given out\n", name, f.unstable,
        1e3 * f.energy_out_J_max);
  }
  const BarFigures f = figuresOf(measurement, &JudgedCell::bounded);
  add("  bounded  unfaithful in %zu of %zu cells that are stable with margin (worst %.1f points)\n",
      f.unfaithful, f.cells_with_margin, f.worst_points);
  add("  bounded  authority below 0.7 in %zu, below 0.5 in %zu of %zu cells (%zu without "
      "reference)\n",
      f.below_0_7, f.below_0_5, f.authority_cells, f.no_reference);
  add("           of these the law on a perfect arm stays below in %zu and %zu\n",
      f.ideal_below_0_7, f.ideal_below_0_5);
  const BarFigures zero = figuresOf(measurement, &JudgedCell::zero_force);
  add("  control  zero force: unfaithful in %zu, authority below 0.5 in %zu: %s\n", zero.unfaithful,
      zero.below_0_5, zero.accepted() ? "PASSES, so the bars ask nothing" : "fails, as it must");
  return text;
}

Status writeStabilityTable(const StabilityMeasurement& measurement,
                           const std::filesystem::path& out) {
  if (Status made = makeFolder(out); !made) return made;
  std::ostringstream csv;
  csv.precision(9);
  csv << "cell,mass_kg,period_s,delay_samples,encoder_mm,plant_damping,hand_k,hand_b,tissue_b,"
         "tissue_k,controller,oscillation_mm,step_N,energy_out_mJ,fidelity_error,authority,stable,"
         "margin\n";
  for (std::size_t i = 0; i < measurement.cells.size(); ++i) {
    const StabilityCell& c = measurement.cells[i];
    for (const auto& [name, column] : kColumns) {
      const CellResult& r = measurement.judged[i].*column;
      csv << i << ',' << c.mass_kg << ',' << c.period_s << ',' << c.delay_samples << ','
          << 1e3 * c.encoder_m << ',' << c.plant_damping << ',' << c.hand.stiffness << ','
          << c.hand.damping << ',' << c.tissue.damping << ',' << c.tissue.stiffness << ',' << name
          << ',' << 1e3 * r.oscillation_m << ',' << r.step_N << ',' << 1e3 * r.energy_out_J << ','
          << r.fidelity_error << ',';
      if (const auto reached = authority(measurement.judged[i], column)) csv << *reached;
      csv << ',' << r.stable << ',' << measurement.judged[i].reference.margin << '\n';
    }
  }
  return writeTextFile(out / "stability.csv", csv.str());
}

}  // namespace trephine
