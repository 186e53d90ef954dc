// What soft tissue pulls back a tool's arm with: written by SoftHold, read by the laws.
#pragma once

#include "base/math.h"
#include "haptics/contact_force.h"
#include "tissue/tissue_set.h"

namespace trephine {

// The spring between a tool in soft tissue and its arm: what an Omni renders. Tuned here, uncited.
constexpr double kCling_N_per_m = 500.0;

// A membrane of a tissue with a rupture force F_r and a travel x_r holds the tip where it met it:
//   F(x) = F_r (exp(3 x / x_r) - 1) / (exp(3) - 1),   x the arm's travel from there,
// until F(x) is the rupture force times the tool's width / 1.2 mm. Then it lets go at once.
bool isMembrane(const TissueClass& tissue);
double membraneForce_N(const TissueClass& tissue, double travel_mm);
double membraneStiffness_N_per_m(const TissueClass& tissue, double travel_mm);
double membraneEnergy_J(const TissueClass& tissue, double travel_mm);
double ruptureForce_N(const TissueClass& tissue, double width_mm);
double ruptureTravel_mm(const TissueClass& tissue, double width_mm);  // at that force

// J/m^2 of new cut surface: the tissue's toughness, or its cutting energy per volume over a slot as
// wide as the tool.
double toughness_J_per_m2(const TissueClass& tissue, double width_mm);

// Forces on the arm, patient axes.
struct SoftPull {
  // Of the tissue before the tool's edge and along its shaft: one spring. Shares of it, which add
  // up to 1 where there is any.
  Vec3 force_N{0.0};
  double stiffness = 0.0;  // N/m; 0: there is none
  double cutting = 0.0, friction = 0.0;
  // The tool is sharp, and what parts for it resists by its toughness: it does not push it out.
  bool parts = false;
  // Of the membrane that holds the tip.
  Vec3 membrane_N{0.0};
  double membrane_stiffness = 0.0;  // N/m, at this travel; 0: there is none
  double membrane_J = 0.0;          // stored

  // Adds the part `of` that one spring, as the arm is shown `share` of its stiffness.
  void addSpring(double share, double of, ContactForce& out) const {
    if (!(stiffness > 0.0) || !(of > 0.0)) return;
    const double k = share * of * stiffness;
    const Vec3 stretch_m = force_N / stiffness;
    out.elastic_N += k * stretch_m;
    out.stiffness += k;
    out.stored_J += 0.5 * k * glm::dot(stretch_m, stretch_m);
  }
};

}  // namespace trephine
