// The rows of `trephine-measure trades` as charts: error over cost, one picture a knob.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "machine/trades/trades_measurement.h"
#include "plot/plot.h"

namespace trephine {

// An axis for figures of 0 or above: logarithmic where they lie above 0 and reach over more than a
// factor of 20, else linear from 0. Every figure lies within.
plot::Axis tradeAxis(const std::string& title, const std::string& unit,
                     const std::vector<double>& figures);

// The rows of one knob, at least one; 1200x800.
plot::Plot tradeChart(const std::vector<TradeRow>& rows);

// Writes FOLDER/trade-KNOB.png for each knob of the rows and returns the paths. A file is whole or
// not touched. Errors: BAD_ARGUMENT for no rows or a figure that is not finite or negative,
// CANNOT_DRAW, CANNOT_WRITE, WRITE_FAILED, CANCELLED.
Result<std::vector<std::filesystem::path>> writeTradeCharts(const std::vector<TradeRow>& rows,
                                                            const std::filesystem::path& folder,
                                                            const Progress& progress = Progress());

}  // namespace trephine
