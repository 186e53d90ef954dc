// Holding still. A tool that rests on a wall rests between two counts of its encoder, and a force
// that follows the counts drives it to and fro between them: too little for any observer to see, and
// for as long as it rests. A force that does not change exchanges nothing over a cycle. So once all
// samples of a while lie within one count, the force stays what it was on average until one leaves.
//
// Not per axis of the encoder but of the contact: along the elastic force, where "the sample" is the
// spring's own deflection (so a tool that slides over rising ground is followed), and across it,
// where it is the position (so friction is held while nothing slides).
#pragma once

#include "base/math.h"

namespace trephine {

class RestHold {
 public:
  RestHold(double encoder_step_m, double period_s) : step_m_(encoder_step_m), T_(period_s) {}

  // The force to send, in contact with a spring of this stiffness [N/m]; without one, `force_N`.
  Vec3 hold(const Vec3& elastic_N, double stiffness, const Vec3& position_m, const Vec3& force_N);
  void forget() { along_ = across_ = Window{}; }

 private:
  struct Window {
    Vec3 low{0.0}, high{0.0};
    Vec3 sum_N{0.0};  // over the ticks, and while holding their mean
    int ticks = 0;
    bool holding = false;
  };
  Vec3 follow(Window& window, const Vec3& sample_m, double width_m, const Vec3& force_N) const;

  double step_m_, T_;
  Vec3 direction_{0.0};  // of the elastic force when the windows began
  Window along_, across_;
};

}  // namespace trephine
