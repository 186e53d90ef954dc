#include "haptics/soft_pull.h"

#include <cmath>

namespace trephine {

namespace {

// The width for which a tissue's rupture force is stated: that of the shipped needle.
constexpr double kStatedWidth_mm = 1.2;
constexpr double kRise = 3.0;  // of a membrane's force: at half its travel it is 18 % of the peak
const double kWhole = std::exp(kRise) - 1.0;

}  // namespace

bool isMembrane(const TissueClass& t) {
  return t.rupture_N > 0.0 && t.rupture_mm > 0.0;
}

double ruptureForce_N(const TissueClass& t, double width_mm) {
  return t.rupture_N * width_mm / kStatedWidth_mm;
}

double membraneForce_N(const TissueClass& t, double travel_mm) {
  return t.rupture_N * (std::exp(kRise * travel_mm / t.rupture_mm) - 1.0) / kWhole;
}

double membraneStiffness_N_per_m(const TissueClass& t, double travel_mm) {
  return 1000.0 * t.rupture_N * kRise / t.rupture_mm * std::exp(kRise * travel_mm / t.rupture_mm) /
         kWhole;
}

double membraneEnergy_J(const TissueClass& t, double travel_mm) {
  const double x = travel_mm / t.rupture_mm;
  return 0.001 * t.rupture_N * t.rupture_mm * ((std::exp(kRise * x) - 1.0) / kRise - x) / kWhole;
}

double toughness_J_per_m2(const TissueClass& t, double width_mm) {
  return t.toughness_J_per_m2 > 0.0 ? t.toughness_J_per_m2 : 1e6 * t.cutting_J_per_mm3 * width_mm;
}

double ruptureTravel_mm(const TissueClass& t, double width_mm) {
  return t.rupture_mm / kRise * std::log(1.0 + kWhole * width_mm / kStatedWidth_mm);
}

}  // namespace trephine
