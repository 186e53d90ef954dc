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
// tissue its stretch shrinks with 1 / k, so that the force goes on from what it was. k is the
// tissue's stiffness [N/m], F its friction [N], both for the whole tool.
//
// Where solid tissue holds the tool back its friction is in the pull between tool and arm
// (Pull::drags): there a spring only goes back, by as much as the arm moves against it. The tool's
// way over an edge is longer than its arm's, so that a spring that followed the tool would give out
// more than the arm had put in.
struct CoulombLaw {
  static constexpr LawWords kWords{
      "coulomb", trLater("Coulomb"),
      trLater("Dry friction: a tool that rests is held, one that slides is braked.")};
  static constexpr std::array kNumbers{&TickNumbers::stiffness_N_per_m, &TickNumbers::friction_N};

  struct Spring {
    Vec3 anchor_m{0.0};
    Vec3 at_m{0.0};          // its point, in the tick before
    double stiffness = 0.0;  // N/m; 0: there is none

    template <class Self, class Archive>
    static void visitState(Self& self, Archive& archive) {
      archive(self.anchor_m, self.at_m, self.stiffness);
    }
  };

  explicit CoulombLaw(std::size_t points = 1) : springs(points) {}
  static Impedance impedance(const TissueClass& tissue) { return {0.0, tissue.stiffness_N_per_m}; }
  void add(const LawInput& in, ContactForce& out);
  void forget() {
    for (Spring& spring : springs) spring.stiffness = 0.0;
  }
  void engage() { forget(); }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.springs);
  }

  std::vector<Spring> springs;  // of each point

 private:
  void goBack(const LawInput& in, const TouchPoint& p, Spring& spring, const Vec3& at_m) const;
};

}  // namespace trephine
