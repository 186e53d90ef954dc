#pragma once

#include <array>

#include "base/tr.h"
#include "haptics/contact_force.h"
#include "haptics/law_input.h"

namespace trephine {

// Seed paper, eq. 1: f = -b v, b the damping of the tissue touched [N s/m]. Over the points of a
// tool: f_i = -w_i b_i (v + omega x r_i).
struct ViscousLaw {
  static constexpr LawWords kWords{
      "viscous", trLater("Viscous"),
      trLater("Tissue resists speed: f = -b v, the seed paper's puncture and cutting.")};
  static constexpr std::array kNumbers{&TickNumbers::damping_Ns_per_m};

  explicit ViscousLaw(std::size_t /*points*/ = 1) {}
  static Impedance impedance(const TissueClass& tissue) { return {tissue.damping_Ns_per_m, 0.0}; }
  void add(const LawInput& in, ContactForce& out) const;
  void forget() {}
};

}  // namespace trephine
