// Quantiles and means of a measurement's figures.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace trephine {

// The least of the ascending `sorted` that so many thousandths of them do not exceed; 0 of none.
inline double quantile(const std::vector<double>& sorted, std::size_t permille) {
  if (sorted.empty()) return 0.0;
  const std::size_t rank = (sorted.size() * permille + 999) / 1000;
  return sorted[std::max<std::size_t>(rank, 1) - 1];
}

// 0 of none.
inline double meanOf(const std::vector<double>& figures) {
  if (figures.empty()) return 0.0;
  return std::accumulate(figures.begin(), figures.end(), 0.0) / double(figures.size());
}

}  // namespace trephine
