#pragma once

#include <array>
#include <vector>

#include "haptics/contact_force.h"
#include "haptics/law_input.h"

namespace trephine {

// Chips and grains that a tool ploughs through: a spring from each point to an anchor that yields,
// as dry friction does, but at a force that grows as the grains are packed before the tool and
// falls as they loosen behind it; beside it they resist speed. All for the whole tool.
struct GranularLaw {
  static constexpr LawWords kWords{
      "granular", "Granular",
      "Grains before the tool are packed, and yield at a force that grows."};
  static constexpr std::array kNumbers{&TickNumbers::damping_Ns_per_m,
                                       &TickNumbers::stiffness_N_per_m, &TickNumbers::friction_N};
  // The grains' own numbers.
  struct Grains {
    double stiffness_share = 0.8;  // of the tissue's, while loose
    double loose_yield = 0.4;      // of the tissue's friction,
    double packed_yield = 1.5;     // and once packed
    double packing_m = 0.004;      // way on which they are packed, to 1 - 1/e
    double loosening_m = 0.002;    // way back on which they loosen
    double resting = 0.05;         // of the packing that is left where the tool has left them
    double damping_share = 0.3;    // of the tissue's damping
  };

  explicit GranularLaw(std::size_t points = 1) : of_points(points) {}
  static Impedance impedance(const TissueClass& tissue) {
    return {Grains{}.damping_share * tissue.damping_Ns_per_m,
            Grains{}.stiffness_share * tissue.stiffness_N_per_m};
  }
  void add(const LawInput& in, ContactForce& out);
  void forget() { of_points.assign(of_points.size(), {}); }
  void engage();

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.of_points);
  }

  struct Point {
    Vec3 anchor_m{0.0};
    Vec3 ahead{0.0};         // unit, the way that packed them
    double packed = 0.0;     // 0 loose, 1 packed
    double stiffness = 0.0;  // N/m; 0: no anchor

    template <class Self, class Archive>
    static void visitState(Self& self, Archive& archive) {
      archive(self.anchor_m, self.ahead, self.packed, self.stiffness);
    }
  };
  std::vector<Point> of_points;
};

}  // namespace trephine
