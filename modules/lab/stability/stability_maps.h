// The judged cells of a stability grid as maps: the tissue over the sampling period, with the
// published limits drawn over them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"

namespace trephine {

// One judged cell of the stability grid for one controller.
struct MapCell {
  std::string controller;
  double mass_kg = 0.0;
  double period_s = 0.0;
  int delay_samples = 0;
  double encoder_m = 0.0;
  double hand_k = 0.0, hand_b = 0.0;      // 0, 0: no hand
  double tissue_b = 0.0, tissue_k = 0.0;  // k == 0: a damper
  bool stable = false;
};

constexpr double kArmDamping_Ns_per_m = 0.05;
constexpr double kArmFriction_N = 0.26;  // Coulomb

// The published limits; below them stable. A damper on a free mass, stepped once a period: 2 m / T.
double damperLimit_Ns_per_m(double mass_kg, double period_s);
// Colgate and Schenkel for a wall without damping of its own: 2 b / T.
double wallLimit_N_per_m(double damping_Ns_per_m, double period_s);
// Abbott and Okamura 2005: the lesser of 2 b / T and 2 f_c / encoder step.
double encoderLimit_N_per_m(double damping_Ns_per_m, double period_s, double friction_N,
                            double encoder_m);

// Centres for values on a logarithmic axis, ascending: the values themselves where they are at most
// `most` and lie apart, otherwise `most` evenly spaced ones from the least to the greatest value.
// A value belongs to the centre nearest to its logarithm.
std::vector<double> logCentres(std::vector<double> values, std::size_t most);
std::size_t nearestCentre(const std::vector<double>& centres, double value);

// A marker: every cell that shares (period, tissue) up to the centres.
struct MapBin {
  double period_s = 0.0;
  double tissue = 0.0;  // b or k
  std::size_t unstable = 0;
  std::size_t total = 0;
};

struct LimitCurve {
  std::string name;  // beside the curve
  std::string legend;
  bool guides = false;  // one that others are compared with: drawn black
  std::function<double(double period_s)> at;
};

struct StabilityMap {
  std::string controller;
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

// Writes each map as FOLDER/<file_name>, 1200x900, and returns their paths. A file is whole or not
// touched; maps written before an error stay. Errors: BAD_ARGUMENT, NO_DISPLAY, NO_OPENGL,
// CANNOT_WRITE, WRITE_FAILED, CANCELLED.
Result<std::vector<std::filesystem::path>> writeStabilityMaps(const std::vector<MapCell>& cells,
                                                              const std::filesystem::path& folder,
                                                              const Progress& progress);

}  // namespace trephine
