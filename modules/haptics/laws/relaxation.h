#pragma once

#include <array>

#include "base/tr.h"
#include "haptics/contact_force.h"
#include "haptics/law_input.h"

namespace trephine {

// A tool that is held in soft tissue loses a share of its force within the tissue's time: the
// springs of the laws membrane, cutting and friction creep (SoftHold). It has no force of its own.
// Members as every law has them: haptics/laws.h.
struct RelaxationLaw {
  static constexpr LawWords kWords{
      "relaxation", trLater("Relaxation"),
      trLater("A tool that is held still in soft tissue loses a part of its force.")};
  static constexpr std::array kNumbers{&TickNumbers::relaxation_share, &TickNumbers::relaxation_s};

  explicit RelaxationLaw(std::size_t /*points*/ = 1) {}
  static Impedance impedance(const TissueClass&) { return {}; }
  void add(const LawInput&, ContactForce&) const {}
  void forget() {}
};

}  // namespace trephine
