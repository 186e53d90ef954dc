// The published limits that stability maps are held against; below them stable.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace trephine {

constexpr double kArmDamping_Ns_per_m = 0.05;
constexpr double kArmFriction_N = 0.26;  // Coulomb

// A damper on a free mass, stepped once a period: 2 m / T.
double damperLimit_Ns_per_m(double mass_kg, double period_s);
// Colgate and Schenkel for a wall without damping of its own: 2 b / T.
double wallLimit_N_per_m(double damping_Ns_per_m, double period_s);
// Abbott and Okamura 2005: the lesser of 2 b / T and 2 f_c / encoder step.
double encoderLimit_N_per_m(double damping_Ns_per_m, double period_s, double friction_N,
                            double encoder_m);

using Hand = std::pair<double, double>;  // b [N s/m], k [N/m]: the lightest first; 0, 0: none
std::string described(const Hand& hand);

struct LimitCurve {
  std::string name;  // beside the curve
  std::string legend;
  bool guides = false;  // one that others are compared with: drawn in the colour of texts
  std::function<double(double period_s)> at;
};

constexpr std::size_t kMostCurves = 4;  // of a family: masses, or encoder steps

// One for each mass [kg], of many a few. `masses` ascends and is not empty.
std::vector<LimitCurve> damperLimits(const std::vector<double>& masses);
// With the lightest hand, without one, and for each encoder step [m] that is not 0.
std::vector<LimitCurve> wallLimits(const std::set<Hand>& hands,
                                   const std::vector<double>& encoders);

}  // namespace trephine
