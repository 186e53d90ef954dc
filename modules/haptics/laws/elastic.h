#pragma once

#include "haptics/contact_force.h"
#include "haptics/law_input.h"

namespace trephine {

// The tissue pushes the tool out along its smoothed normal: f = k depth n, summed over layers, as
// the tool's ball feels it (stiffness_ball.h). While the ball's centre is in tissue of stiffness K
// the ball's sum is K (r - |a|), a the centre's depth; a blunt tool gets K (r + |a|) instead, and
// keeps the last clear normal when tissue closes all around. A sharp tool has parted the tissue: for
// it the push fades as the ball sinks in.
struct ElasticLaw {
  explicit ElasticLaw(std::size_t /*points*/ = 1) {}
  void add(const LawInput& in, ContactForce& out);
  void forget() { normal = Vec3(0.0); }

  Vec3 normal{0.0};  // the last clear one, out of the tissue
};

}  // namespace trephine
