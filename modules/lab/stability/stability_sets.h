// What a grid of two seconds under a resting hand does not show: minutes, hands that move, hands of
// other kinds, and arms that are not what was claimed of them. Only `bounded` is asked.
//
// Each set takes cells (of which it may replace the hand) through one or more variations; a row is
// one variation. A cell is counted
//   unstable    by the definition of stability_cell.h;
//   also_ideal  instead, where the continuous law on a perfect arm under the same hand has every
//   one
//               of the faults: an undamped hand on a spring swings for ever, whoever answers it.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "lab/stability/stability_cell.h"

namespace trephine {

enum class StabilitySet {
  grid,     // every controller on the grid: stability_measurement.h
  lasting,  // "long": the full grid for 30 s
  moving,   // the hand's rest point swings by 4 mm at 1 Hz after the ramp; cells with a hand, 5 s
  hands,    // k 50 to 2000 N/m with b 1 to 10 N s/m; b 0 in rows that no total counts
  claims,   // mass 0.5, 1.5, 2, 5 times the true one; delay one more or less; encoder exact
  rest,     // whole exercises
};
inline constexpr std::array<std::pair<std::string_view, StabilitySet>, 6> kStabilitySetNames{
    {{"grid", StabilitySet::grid},
     {"long", StabilitySet::lasting},
     {"moving", StabilitySet::moving},
     {"hands", StabilitySet::hands},
     {"claims", StabilitySet::claims},
     {"rest", StabilitySet::rest}}};

// "grid,hands". Error: BAD_ARGUMENT for a name that is none, and for none at all.
Result<std::vector<StabilitySet>> readStabilitySets(const std::string& names);

struct SetRow {
  std::string name;
  std::size_t cells = 0, unstable = 0, also_ideal = 0;
  std::size_t not_as_stated =
      0;  // in which the controller says so; false ones where claims are right
  // Of the cells that are not also_ideal.
  double energy_out_J_max = 0.0;
  double cycle_m_max = 0.0, cycle_Hz = 0.0;  // the largest limit cycle, peak to peak
};
struct SetFigures {
  SetRow total;
  std::vector<SetRow> rows;
};

// 304 cells of the full grid: every 2252nd, round and round. 2252 shares no factor with the 3645
// and is near their golden section, so that each value of each axis comes about equally often with
// each of the others.
std::vector<StabilityCell> representativeCells();

// `lasting`, `moving`, `hands` or `claims` on these cells. Without `seconds` as said above, 2 s
// where nothing is said. Errors: CANCELLED.
Result<SetFigures> measureStabilitySet(StabilitySet set, const std::vector<StabilityCell>& cells,
                                       std::optional<double> seconds, const Progress& progress);

// {cells, unstable, also_ideal, energy_out_mJ_max, cycle_um_max, cycle_Hz,
//  not_as_stated, rows: [{name, ...}]}
Json toJson(const SetFigures& figures);
std::string toText(const std::string& name, const SetFigures& figures);

}  // namespace trephine
