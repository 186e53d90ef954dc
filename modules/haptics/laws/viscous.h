#pragma once

#include <array>

#include "base/tr.h"
#include "haptics/contact_force.h"
#include "haptics/law_input.h"

namespace trephine {

// f = -b v on the arm, b the damping of the tissue touched [N s/m] (the seed paper, eq. 1). Over
// the points of a tool f_i = -w_i b_i (v + omega x r_i), with the torque r_i x f_i about the tip:
// w_i the point's share of the tool, v the tip's velocity, r_i the lever from the tip. Patient
// axes, SI. Members: haptics/laws.h.
struct ViscousLaw {
  static constexpr LawWords kWords{"viscous", trLater("Viscous"),
                                   trLater("Tissue resists speed: f = -b v.")};
  static constexpr std::array kNumbers{&TickNumbers::damping_Ns_per_m};

  explicit ViscousLaw(std::size_t /*points*/ = 1) {}
  static Impedance impedance(const TissueClass& tissue) { return {tissue.damping_Ns_per_m, 0.0}; }
  void add(const LawInput& in, ContactForce& out) const;
  void forget() {}
};

}  // namespace trephine
