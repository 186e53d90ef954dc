#pragma once

#include "haptics/contact_force.h"
#include "haptics/law_input.h"

namespace trephine {

// Solid tissue holds the tool's proxy, and a spring of the tissue's stiffness k pulls the arm to it:
// f = k (proxy - arm), torque k r^2 (turn between them), r the length by which the proxy weighs turns
// against shifts (proxy.h).
//
// Soft tissue pushes the tool out along its smoothed normal: f = k depth n, summed over layers, as
// the tool's ball feels it (stiffness_ball.h). Once the ball's centre is in tissue its depth is
// counted on from there along the normal at which it went in, however deep it sinks; where K falls
// the push falls with it, where it rises the depth shrinks with 1 / K, so that no energy is made. A
// tool that parts the tissue is another matter: for it the push fades as the ball sinks in, and does
// not come back on the way out.
struct ElasticLaw {
  explicit ElasticLaw(std::size_t /*points*/ = 1) {}
  void add(const LawInput& in, ContactForce& out);
  void forget() { *this = ElasticLaw(); }

  Vec3 normal{0.0};  // the last clear one, out of the tissue
  // Of a ball whose centre is in tissue: how deep its surface is, where its centre was in the tick
  // before, and that tissue's stiffness.
  double depth_m = 0.0;
  Vec3 centre_m{0.0};
  double stiffness = 0.0;  // N/m; 0: the centre is in none
  // Of a tool that parts the tissue.
  bool parted = false;
  double most_N = 0.0;

 private:
  void addSolid(const LawInput& in, ContactForce& out) const;
  void addSoft(const LawInput& in, ContactForce& out);
};

}  // namespace trephine
