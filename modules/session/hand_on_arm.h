// When a hand is on an arm, and when it has let go. Pure.
#pragma once

#include "base/math.h"

namespace trephine {

// What a sample of an arm says of the hand on it. `away`: it is lost, its sample is old, or it
// reports an error; `no_hand`: it knows that nobody holds it, as in its holder.
struct HandSample {
  Vec3 position_m{0.0};
  bool button = false, no_hand = false, away = false;
};

// A hand is on the arm once a button is held, and then for as long as that is; or, without, once
// the arm has been moved 5 mm from where it was first seen, for 20 samples. Where it jumps by 5 mm
// from one sample to the next, an encoder has jumped: it is then first seen there. Where it goes
// faster than a hand it was struck: it is then first seen where it has stayed within 2 mm for half
// a second. A blow that is over within 8 ms is too short to be told from a hand.
class HandOnArm {
 public:
  // No hand that holds an arm goes faster: it was struck, or, over this time, has lost the hand.
  static constexpr double kTooFast_m_s = 0.5, kSpeedOver_s = 0.01;

  // Of each sample until it is true: the hand has taken the arm.
  bool takes(const HandSample& sample, double period_s);
  // Of each sample after that.
  bool letsGo(const HandSample& sample) const {
    return sample.no_hand || (by_button_ && !sample.button);
  }

 private:
  int moved_ = 0;  // samples
  bool seen_ = false, struck_ = false, by_button_ = false;
  Vec3 seen_at_m_{0.0}, last_m_{0.0}, rough_m_s_{0.0}, speed_m_s_{0.0}, mean_m_{0.0}, rest_m_{0.0};
  double rested_s_ = 0.0;  // within 2 mm of there
};

}  // namespace trephine
