#include "plot/checks.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/codes.h"
#include "base/tr.h"

namespace trephine::plot {

namespace {

// Ticks have as many digits as tell them apart, of which a double has 15.
bool possible(const Axis& axis) {
  const double largest = std::max(std::abs(axis.low), std::abs(axis.high));
  return axis.high - axis.low >= std::max(1e-300, 1e-12 * largest) && largest <= 1e300;
}

bool possible(const Line& line) {
  return line.width_px > 0.0 && line.width_px < 1000.0 && line.dashes_px.size() % 2 == 0 &&
         std::all_of(line.dashes_px.begin(), line.dashes_px.end(),
                     [](double dash) { return dash >= 1.0; });
}

bool ascending(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), std::not_fn(std::less<>())) ==
         values.end();
}

}  // namespace

Status checked(const Plot& plot) {
  const auto bad = [](const std::string& what) {
    return Error{code::kBadArgument, what, tr("the plot"), ""};
  };
  if (std::min(plot.width_px, plot.height_px) < 200 ||
      std::max(plot.width_px, plot.height_px) > 8192) {
    return bad(tr("The picture's edges must have 200 to 8192 pixels"));
  }
  if (!possible(plot.x) || !possible(plot.y)) {
    return bad(
        tr("An axis must go from a lower to a higher number, told apart by their first digits"));
  }
  for (const Line& line : plot.lines) {
    if (!possible(line)) {
      return bad(tr("A line has a width above 0, its dashes come in pairs of 1 pixel or more"));
    }
  }
  if (!plot.heat_map) return {};
  if (!ascending(plot.heat_map->columns) || !ascending(plot.heat_map->rows)) {
    return bad(tr("The columns and rows of cells ascend"));
  }
  for (const HeatMap::Cell& cell : plot.heat_map->cells) {
    if (cell.level >= plot.heat_map->levels.size()) return bad(tr("A cell has a level of its own"));
    if (!plot.x.holds(cell.at.x) || !plot.y.holds(cell.at.y)) {
      return bad(tr("A cell lies outside of the axes"));
    }
  }
  return {};
}

}  // namespace trephine::plot
