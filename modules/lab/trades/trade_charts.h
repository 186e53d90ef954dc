// The rows of `measure trades` as charts: error over cost, one picture a knob.
#pragma once

#include <filesystem>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "lab/trades/trades_measurement.h"

namespace trephine {

// One axis of a chart: logarithmic where the values lie above 0 and reach over more than a factor
// of 20, else linear from 0. Low < high and every value within.
struct TradeAxis {
  bool logarithmic = false;
  double low = 0.0, high = 1.0;   // decades where logarithmic
  std::vector<double> ticks;      // values, ascending, at least two
  double at(double value) const;  // 0 at the low end, 1 at the high one
};
TradeAxis tradeAxis(const std::vector<double>& values);

// Writes FOLDER/trade-KNOB.png, 1200x800, for each knob of the rows and returns the paths. A file
// is whole or not touched. Errors: BAD_ARGUMENT for no rows or a figure that is not finite or
// negative, NO_DISPLAY, NO_OPENGL, CANNOT_WRITE, WRITE_FAILED, CANCELLED.
Result<std::vector<std::filesystem::path>> writeTradeCharts(const std::vector<TradeRow>& rows,
                                                            const std::filesystem::path& folder,
                                                            const Progress& progress = Progress());

}  // namespace trephine
