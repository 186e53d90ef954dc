#include "lab/stability/log_centres.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trephine {

std::vector<double> distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto same = [](double a, double b) { return b - a <= 1e-9 * b; };
  values.erase(std::unique(values.begin(), values.end(), same), values.end());
  return values;
}

std::vector<double> logCentres(std::vector<double> values, std::size_t most) {
  values = distinct(std::move(values));
  if (values.size() < 2) return values;
  const double low = std::log10(values.front()), high = std::log10(values.back());
  const double gap = (high - low) / double(most - 1);
  bool apart = values.size() <= most;
  for (std::size_t i = 1; i < values.size() && apart; ++i) {
    apart = std::log10(values[i]) - std::log10(values[i - 1]) >= gap * (1.0 - 1e-9);
  }
  if (apart) return values;
  std::vector<double> centres(most);
  for (std::size_t i = 0; i < most; ++i) centres[i] = std::pow(10.0, low + gap * double(i));
  centres.front() = values.front();
  centres.back() = values.back();
  return centres;
}

std::size_t nearestCentre(const std::vector<double>& centres, double value) {
  const auto above = std::lower_bound(centres.begin(), centres.end(), value);
  if (above == centres.begin()) return 0;
  const std::size_t i = std::size_t(above - centres.begin());
  if (above == centres.end()) return i - 1;
  const double up = std::log10(centres[i]) - std::log10(value);
  return up < std::log10(value) - std::log10(centres[i - 1]) ? i : i - 1;
}

}  // namespace trephine
