#pragma once

#include "haptics/contact_force.h"
#include "haptics/law_input.h"

namespace trephine {

// The tissue pushes the tool out along its smoothed normal: f = k depth n, summed over layers, as
// the tool's ball feels it (stiffness_ball.h). While the ball's centre is in tissue of stiffness K
// the ball's sum is K (r - |a|), a the centre's depth; a blunt tool gets K (r + |a|) instead, and
// keeps the last clear normal when tissue closes all around. A sharp tool has parted the tissue: for
// it the push fades as the ball sinks in, and does not come back on the way out.
struct ElasticLaw {
  explicit ElasticLaw(std::size_t /*points*/ = 1) {}
  void add(const LawInput& in, ContactForce& out);
  void forget() { *this = ElasticLaw(); }

  Vec3 normal{0.0};  // the last clear one, out of the tissue
  bool parted = false;
  double most_N = 0.0;  // of a tool that has parted the tissue
};

}  // namespace trephine
