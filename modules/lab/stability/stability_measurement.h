// The stability laboratory: every controller over a grid of cells, judged against the bars.
// Definitions: stability_cell.h; what more is asked of `bounded`: stability_sets.h. The figures are
// those of the run that prints them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "lab/stability/stability_cell.h"
#include "lab/stability/stability_maps.h"

namespace trephine {

// {"cells":[{"mass_kg","period_s","delay_samples","encoder_mm","plant_damping":0.05,
//            "hand":{"k","b"}|null,"tissue":{"b","k"}}]}
// Errors: MISSING_FILE, BAD_JSON, BAD_FIELD (file, field and value named).
Result<std::vector<StabilityCell>> readGrid(const std::filesystem::path& file);

struct JudgedCell {
  CellReference reference;
  CellResult off, seed, bounded, zero_force;
  std::optional<double> ideal_authority;  // where `bounded` has less than 0.7
};

// A controller against the bars that ask something of it.
struct BarFigures {
  std::size_t cells = 0, unstable = 0;
  double energy_out_J_max = 0.0;
  std::size_t cells_with_margin = 0, unfaithful = 0;  // among those stable with margin
  double worst_points = 0.0;                          // fidelity error beyond off's, in 100ths
  std::size_t authority_cells = 0, no_reference = 0, below_0_7 = 0, below_0_5 = 0;
  std::optional<double> lowest_authority;
  // Of those below, where the continuous law on a perfect arm stays below as well.
  std::size_t ideal_below_0_7 = 0, ideal_below_0_5 = 0;

  // At most 1 % unstable, 10 % unfaithful, 20 % with authority below 0.5.
  bool accepted() const;
};

struct StabilityMeasurement {
  std::vector<StabilityCell> cells;
  std::vector<JudgedCell> judged;
};

// On all processors. Errors: CANCELLED.
Result<StabilityMeasurement> measureStability(std::vector<StabilityCell> cells, const Progress&,
                                              double seconds = kCellDuration_s);

BarFigures figuresOf(const StabilityMeasurement& measurement, CellResult JudgedCell::*controller);

// A cell that misses a bar, and what held it back.
struct MissedBar {
  std::size_t cell = 0;
  std::string bar;  // "stable", "faithful", "authority"
  double value = 0.0;
  std::string cause;
};
std::vector<MissedBar> missedBars(const StabilityMeasurement& measurement);

// What the maps show of it.
std::vector<MapCell> mapCells(const StabilityMeasurement& measurement);

Json toJson(const StabilityMeasurement& measurement);
std::string toText(const StabilityMeasurement& measurement);
// stability.csv in `out`, one line a cell and controller.
Status writeStabilityTable(const StabilityMeasurement& measurement,
                           const std::filesystem::path& out);

}  // namespace trephine
