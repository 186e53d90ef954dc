#include "lab/stability/stability_limits.h"

#include <algorithm>

#include "plot/axis.h"

namespace trephine {

using plot::number;

namespace {

// At most `most` of them, evenly through the order, the first and the last among them.
std::vector<double> some(const std::vector<double>& values, std::size_t most) {
  if (values.size() <= most) return values;
  std::vector<double> chosen;
  for (std::size_t i = 0; i < most; ++i) {
    chosen.push_back(values[i * (values.size() - 1) / (most - 1)]);
  }
  return chosen;
}

std::string ofHowMany(std::size_t shown, std::size_t all, const std::string& things) {
  if (shown == all) return {};
  return " (" + std::to_string(shown) + " of " + std::to_string(all) + " " + things + ")";
}

}  // namespace

double damperLimit_Ns_per_m(double mass_kg, double period_s) {
  return 2.0 * mass_kg / period_s;
}

double wallLimit_N_per_m(double damping_Ns_per_m, double period_s) {
  return 2.0 * damping_Ns_per_m / period_s;
}

double encoderLimit_N_per_m(double damping_Ns_per_m, double period_s, double friction_N,
                            double encoder_m) {
  return std::min(wallLimit_N_per_m(damping_Ns_per_m, period_s), 2.0 * friction_N / encoder_m);
}

std::string described(const Hand& hand) {
  if (hand == Hand()) return "none";
  return number(hand.second) + " N/m + " + number(hand.first) + " N s/m";
}

std::vector<LimitCurve> damperLimits(const std::vector<double>& masses) {
  std::vector<LimitCurve> curves;
  const std::vector<double> shown = some(masses, kMostCurves);
  for (const double mass : shown) {
    const std::string m = "m = " + number(mass, 3) + " kg";
    curves.push_back({m, "b = 2 m/T, no hand, " + m, false,
                      [=](double period) { return damperLimit_Ns_per_m(mass, period); }});
  }
  curves.back().legend += ofHowMany(shown.size(), masses.size(), "masses");
  return curves;
}

// A marker may hold cells with and without a hand, for which the limits lie far apart: both are
// drawn. The lightest hand is the one that damps least.
std::vector<LimitCurve> wallLimits(const std::set<Hand>& hands,
                                   const std::vector<double>& encoders) {
  std::vector<LimitCurve> curves;
  const auto colgate = [&](const std::string& name, const std::string& who, double damping) {
    curves.push_back({name, "Colgate & Schenkel K = 2 b/T, b = " + who, true,
                      [=](double period) { return wallLimit_N_per_m(damping, period); }});
  };
  const std::string arm = number(kArmDamping_Ns_per_m);
  double damping = kArmDamping_Ns_per_m;
  std::string same = "b = " + arm + " N s/m";
  const auto lightest = hands.upper_bound(Hand());
  if (lightest != hands.end()) {
    damping += lightest->first;
    same = "b with hand";
    colgate("C&S, hand",
            arm + " (arm) + " + number(lightest->first) +
                " N s/m (lightest hand: " + described(*lightest) + ")",
            damping);
  }
  if (hands.count(Hand())) {
    colgate("C&S, no hand", arm + " N s/m (arm, no hand)", kArmDamping_Ns_per_m);
  }
  std::vector<double> steps = encoders;
  std::erase(steps, 0.0);
  const std::vector<double> shown = some(steps, kMostCurves - 1);
  const std::string formula = "Abbott & Okamura 2005 K = min(2 b/T, 2 f_c/step), " + same +
                              ", f_c = " + number(kArmFriction_N) + " N (arm), step ";
  for (const double step : shown) {
    const std::string mm = number(step * 1000.0, 3) + " mm";
    curves.push_back({"A&O, " + mm, formula + mm, false, [=](double period) {
                        return encoderLimit_N_per_m(damping, period, kArmFriction_N, step);
                      }});
  }
  if (!shown.empty()) curves.back().legend += ofHowMany(shown.size(), steps.size(), "steps");
  return curves;
}

}  // namespace trephine
