#pragma once

#include <array>
#include <vector>

#include "base/tr.h"
#include "haptics/contact_force.h"
#include "haptics/law_input.h"

namespace trephine {

// Dry friction with stiction, position-based (Hayward and Armstrong 2000): a spring from each point
// to an anchor set where its contact began, f = -w k (x - anchor), and |f| <= w F: beyond the
// tissue's friction F the anchor is dragged along. At rest the anchor stands still, so the force
// neither drifts nor buzzes; energy is stored or lost, never made: where a point comes into stiffer
// tissue its stretch shrinks with 1 / k, so that the force goes on from what it was. k is the tissue's stiffness [N/m],
// F its friction [N], both for the whole tool.
struct CoulombLaw {
  static constexpr LawWords kWords{
      "coulomb", trLater("Coulomb"),
      trLater("Dry friction: a tool that rests is held, one that slides is braked.")};
  static constexpr std::array kNumbers{&TickNumbers::stiffness_N_per_m, &TickNumbers::friction_N};

  explicit CoulombLaw(std::size_t points = 1) : anchors_m(points), stiffness(points, 0.0) {}
  static Impedance impedance(const TissueClass& tissue) { return {0.0, tissue.stiffness_N_per_m}; }
  void add(const LawInput& in, ContactForce& out);
  void forget() { stiffness.assign(stiffness.size(), 0.0); }
  void engage() { forget(); }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.anchors_m, self.stiffness);
  }

  std::vector<Vec3> anchors_m;
  std::vector<double> stiffness;  // of each point's spring; 0: no anchor
};

}  // namespace trephine
