// Rows of trades, made up.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "machine/trades/trades_measurement.h"

namespace trephine::test {

inline TradeRow row(const char* knob, const char* setting, double error, double cost,
                    std::vector<std::pair<std::string, double>> extra = {}) {
  TradeRow r;
  r.knob = knob;
  r.setting = setting;
  r.error = error;
  r.error_unit = "%";
  r.cost = cost;
  r.cost_unit = "ns";
  r.reference = "truth";
  r.extra = std::move(extra);
  return r;
}

}  // namespace trephine::test
