// The judged cells of a stability grid, counted: the tissue over the sampling period, with the
// published limits.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/result.h"
#include "lab/stability/stability_limits.h"

namespace trephine {

// One judged cell of the stability grid for one controller.
struct MapCell {
  std::string controller;
  double mass_kg = 0.0;
  double period_s = 0.0;
  double delay_samples = 0.0;
  double encoder_m = 0.0;
  double hand_k = 0.0, hand_b = 0.0;      // 0, 0: no hand
  double tissue_b = 0.0, tissue_k = 0.0;  // k == 0: a damper
  bool stable = false;
};

// A marker: every cell that shares (period, tissue) up to the centres.
struct MapBin {
  double period_s = 0.0;
  double tissue = 0.0;  // b or k
  std::size_t unstable = 0;
  std::size_t total = 0;
};

struct StabilityMap {
  std::string title;
  bool walls = false;      // or dampers
  std::string file_name;   // CONTROLLER-dampers-HAND.png; HAND: no-hand, hand-K-B, all-hands
  std::string conditions;  // what the cells of a marker differ in
  std::string hands;
  std::string note;             // of values put together or left out, or empty
  std::vector<double> periods;  // centres, ascending
  std::vector<double> tissues;
  bool periods_exact = true;  // the centres are the values
  bool tissues_exact = true;
  std::vector<MapBin> bins;  // by period, then tissue
  std::vector<LimitCurve> limits;
};

constexpr std::size_t kMostCentres = 20;  // an axis: more would not leave room for the counts

// One map a controller and kind, controllers in the order of their first cell. A damper of b = 0
// has no place on a logarithmic axis and is only counted in the note. Error: BAD_ARGUMENT for no
// cell, a cell with a value that cannot be, or nothing but dampers of b = 0.
Result<std::vector<StabilityMap>> stabilityMaps(const std::vector<MapCell>& cells);

}  // namespace trephine
