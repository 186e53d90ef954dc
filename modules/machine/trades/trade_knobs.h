// The knobs of the trades, one function each: its rows, none recommended yet. Cost is
// measured on the calling thread. Errors: CANCELLED.
#pragma once

#include <vector>

#include "base/codes.h"
#include "base/progress.h"
#include "base/result.h"
#include "base/tr.h"
#include "haptics/tool.h"
#include "machine/trades/trades_measurement.h"
#include "volume/volume.h"

namespace trephine {

using TradeRows = Result<std::vector<TradeRow>>;

// Points of a blade or burr, against 8 times the most of `counts`: force over a stroke that crosses
// the surface obliquely, and what it removes by the hand's work alone.
TradeRows tradePoints(ToolKind kind, const std::vector<int>& counts, const TradesOptions& options,
                      const Progress& progress);

// At the tip or over the points, against the line integral of eq. 1 along a blade that turns, half
// in tissue.
TradeRows tradeForceAt(const TradesOptions& options, const Progress& progress);

// The rate of touch, against 80 kHz, on a simulated arm in a hand.
TradeRows tradeRate(const TradesOptions& options, const Progress& progress);

// Every voxel the mean of `factor`^3, in the same place; edges are whole multiples of the factor.
Volume averaged(const Volume& fine, int factor);

// The grid as it is, at half and at a quarter of its resolution, against the first.
TradeRows tradeGrid(const TradesOptions& options, const Progress& progress);

// The ray caster on the cranium and a shell of bone. No rows where nothing can be drawn.
TradeRows tradeRayCasting(const TradesOptions& options, const Progress& progress);
// As rows, recommendations and `explain` name it.
std::string rayCastingSetting(double distance_voxels, bool plain);

inline Error tradesCancelled() {
  return {code::kCancelled, tr("The measurement was cancelled"), "trades", ""};
}

}  // namespace trephine
