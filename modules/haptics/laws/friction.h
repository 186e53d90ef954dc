#pragma once

#include <array>

#include "base/tr.h"
#include "haptics/contact_force.h"
#include "haptics/law_input.h"

namespace trephine {

// In soft tissue: so much force per millimetre of shaft that lies in it, against any motion,
// however many points the tool has. On solid tissue: Coulomb's, mu times the force with which the
// tool is pressed on it, in the pull between tool and arm (proxy.h). Members as every law has them:
// haptics/laws.h. Patient axes, SI; the haptic thread.
struct FrictionLaw {
  static constexpr LawWords kWords{
      "friction", trLater("Friction"),
      trLater("Soft tissue brakes a shaft by its length in it, solid tissue by the push on it.")};
  static constexpr std::array kNumbers{&TickNumbers::shaft_N_per_mm,
                                       &TickNumbers::friction_coefficient};

  static constexpr bool kEachAlone = true;
  static constexpr bool kSharesSpring = true;  // SoftPull's

  explicit FrictionLaw(std::size_t /*points*/ = 1) {}
  static Impedance impedance(const TissueClass& tissue) {
    return {0.0, !tissue.solid && tissue.shaft_N_per_mm > 0.0 ? kCling_N_per_m : 0.0};
  }
  void add(const LawInput& in, ContactForce& out) const {
    in.soft.addSpring(in.share.stiffness, in.soft.friction, out);
  }
  void forget() {}
};

}  // namespace trephine
