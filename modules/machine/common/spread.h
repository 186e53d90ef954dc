// How figures of a measurement spread, and how that is said. Of figures that were not measured:
// nothing, said as null. Quantiles are figures of the list, by the nearest rank: of fewer than 100,
// p99 is the largest. Figures are numbers, in the unit that the JSON's key names.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "base/json.h"
#include "machine/common/quantile.h"

namespace trephine {

struct Spread {
  double median = 0.0, p99 = 0.0, max = 0.0;
  std::size_t count = 0;
};

inline Spread spreadOf(std::vector<double> figures) {
  std::sort(figures.begin(), figures.end());
  return {quantile(figures, 500), quantile(figures, 990), quantile(figures, 1000), figures.size()};
}

inline Json toJson(const Spread& of) {
  if (of.count == 0) return nullptr;
  return {{"median", of.median}, {"p99", of.p99}, {"max", of.max}, {"count", of.count}};
}

template <class T>
Json orNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

}  // namespace trephine
