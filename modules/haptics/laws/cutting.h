#pragma once

#include <array>

#include "base/tr.h"
#include "haptics/contact_force.h"
#include "haptics/law_input.h"

namespace trephine {

// A tip or an edge that goes on through whole tissue feels its toughness J_c times the width that
// is engaged, against its motion, one way; less where an edge slides along itself: of a way with
// the share c across the edge, J_c w c (Atkins, Xu and Jeronimidis 2004: by the work per new
// surface). It sticks and slips (SoftHold). A tool whose motor runs feels none of it.
// Members as every law has them: haptics/laws.h. Patient axes, SI; the haptic thread.
struct CuttingLaw {
  static constexpr LawWords kWords{
      "cutting", trLater("Cutting"),
      trLater("Whole tissue resists an edge by its toughness times the width that it cuts.")};
  static constexpr std::array kNumbers{&TickNumbers::toughness_J_per_m2,
                                       &TickNumbers::cutting_J_per_mm3};

  static constexpr bool kEachAlone = true;
  static constexpr bool kSharesSpring = true;  // SoftPull's

  explicit CuttingLaw(std::size_t /*points*/ = 1) {}
  static Impedance impedance(const TissueClass& tissue) {
    return {0.0, tissue.solid ? 0.0 : kCling_N_per_m};
  }
  void add(const LawInput& in, ContactForce& out) const {
    in.soft.addSpring(in.share.stiffness, in.soft.cutting, out);
  }
  void forget() {}
};

}  // namespace trephine
