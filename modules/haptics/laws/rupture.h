#pragma once

#include <array>
#include <cstdint>

#include "base/tr.h"
#include "haptics/contact_force.h"
#include "haptics/law_input.h"

namespace trephine {

struct ElasticLaw;

// A capsule before a sharp tip: elastic up to a force, then it gives way and the force drops
// (puncture of soft tissue: Okamura, Simone and O'Leary 2004). Where the tip enters a tissue that
// has a rupture force F_r > 0, f = -k (x - entry) while the tip is pressed further in than there;
// at |x - entry| = F_r / k the tissue ruptures and stays so until the tool has left all tissue. A
// tip that draws back before that leaves it whole. A second capsule that the tip enters pushes only
// once the first has given way or the tip has drawn back from it.
// Members as every law has them: haptics/laws.h. Patient axes, SI; the haptic thread.
struct RuptureLaw {
  static constexpr LawWords kWords{
      "rupture", trLater("Rupture"),
      trLater("A capsule gives way at its rupture force, and the force drops.")};
  static constexpr std::array kNumbers{&TickNumbers::stiffness_N_per_m, &TickNumbers::rupture_N};

  explicit RuptureLaw(std::size_t /*points*/ = 1) {}
  // In a tissue with a rupture force elastic push is by this law alone, before it gives way and
  // after: then there is none.
  using StandsInFor = ElasticLaw;
  static Impedance impedance(const TissueClass& tissue) {
    return {0.0, tissue.rupture_N > 0.0 ? tissue.stiffness_N_per_m : 0.0};
  }
  void add(const LawInput& in, ContactForce& out);
  void forget() { *this = RuptureLaw(); }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive.within(self.stretched, -1, std::int64_t(kMaxTissues));
    archive(self.ruptured, self.entry_m, self.inwards);
  }

  std::int32_t stretched = -1;  // the tissue class that is being pressed in
  std::uint32_t ruptured = 0;   // bit c: class c has given way
  Vec3 entry_m{0.0};
  // Unit: how the tip moved at the entry; where it stood still, from the handle to the tip.
  Vec3 inwards{0.0};
};

}  // namespace trephine
