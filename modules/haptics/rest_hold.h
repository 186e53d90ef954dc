// Holding still. A tool that rests on a wall rests between two counts of its encoder, and a force
// that follows the counts drives a limit cycle of 20 to 140 um between them, with less energy a
// cycle than an observer sees. A force that does not change exchanges nothing over a cycle. So once
// all samples of 0.12 s lie within one count, the force is held at its mean over that time until a
// sample leaves the count.
//
// Not per axis of the encoder but of the contact: along the elastic force, where "the sample" is
// the force of the spring's own deflection (so a tool that slides over rising ground is followed),
// and across it, where it is the position (so friction is held while nothing slides). A count is
// worth the stiffness times its length; the force is not divided by the stiffness, which itself
// comes and goes with the points that touch. And since no soft tissue's slope is just its
// stiffness, a force that changes by two counts' worth rests as well, where the position along it
// lies within one.
//
// The rendered stiffness may have risen while the force was held. Of the jump as a count is left,
// what exceeds the force of one count fades with a time constant of 20 ms.
#pragma once

#include "base/math.h"

namespace trephine {

class RestHold {
 public:
  RestHold(double encoder_step_m, double period_s) : step_m_(encoder_step_m), T_(period_s) {}

  // The force to send instead of `force_N`, in contact with a spring of this stiffness [N/m] that
  // pushes by `elastic_N` when all of it is shown; without one, `force_N`.
  Vec3 hold(const Vec3& elastic_N, double stiffness, const Vec3& position_m, const Vec3& force_N);
  void forget() { along_ = across_ = Window{}; }
  // All of the force is held.
  bool rests() const { return along_.holding && across_.holding; }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.direction_, self.along_, self.across_);
  }

 private:
  struct Window {
    Vec3 low{0.0}, high{0.0};
    Vec3 sum_N{0.0};  // over the ticks, and while holding their mean
    int ticks = 0;
    bool holding = false;
    Vec3 fading_N{0.0};  // what is left of the jump as the hold ended

    template <class Self, class Archive>
    static void visitState(Self& self, Archive& archive) {
      archive(self.low, self.high, self.sum_N);
      archive(self.ticks, self.holding, self.fading_N);
    }
  };
  // `rests` is asked of how far the samples of the window lie apart on each axis; a count is worth
  // `count_N`.
  template <class Rests>
  Vec3 follow(Window& window, const Vec3& sample, const Vec3& force_N, double count_N,
              const Rests& rests) const;

  double step_m_, T_;
  Vec3 direction_{0.0};  // of the elastic force when the windows began
  Window along_, across_;
};

}  // namespace trephine
