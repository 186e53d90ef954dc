#pragma once

#include <array>

#include "base/tr.h"
#include "haptics/contact_force.h"
#include "haptics/law_input.h"

namespace trephine {

struct ElasticLaw;

// A membrane stops a tip, its force rises concave-up with the arm's travel, and it gives way at
// once (the rise: Okamura, Simone and O'Leary 2004, a polynomial there; here an exponential, as of
// soft tissue under tension). The wider the tool the more it bears. Where it is and whether it is
// whole: SoftHold.
// Members as every law has them: haptics/laws.h. Patient axes, SI; the haptic thread.
struct MembraneLaw {
  static constexpr LawWords kWords{
      "membrane", trLater("Membrane"),
      trLater("A membrane stops a tip, resists more and more, then gives way at once.")};
  static constexpr std::array kNumbers{&TickNumbers::rupture_N, &TickNumbers::rupture_mm};

  // It pushes in place of the tissue behind it.
  using StandsInFor = ElasticLaw;

  explicit MembraneLaw(std::size_t /*points*/ = 1) {}
  // The stiffness at which it gives way to a tool 1.2 mm wide.
  static Impedance impedance(const TissueClass& tissue) {
    return {0.0, isMembrane(tissue) ? membraneStiffness_N_per_m(tissue, tissue.rupture_mm) : 0.0};
  }
  void add(const LawInput& in, ContactForce& out) const {
    if (!(in.soft.membrane_stiffness > 0.0)) return;
    out.elastic_N += in.share.stiffness * in.soft.membrane_N;
    out.stiffness += in.share.stiffness * in.soft.membrane_stiffness;
    out.stored_J += in.share.stiffness * in.soft.membrane_J;
  }
  void forget() {}
};

}  // namespace trephine
