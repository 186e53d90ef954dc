// A force by which a person can tell that an arm works: upward, slowly rising to a known size, felt
// by a hand that is known to hold the arm. Pure.
#pragma once

#include "session/hand_on_arm.h"

namespace trephine {

// Up to `most_N` over 3 s, held for 2 s, and gone over 1 s.
//
// It begins with a hand on the arm. Letting go ends it (done), without force from that tick on. A
// hand that goes faster than 0.5 m/s has lost the arm, as has one whose arm is away: it ends
// (lost). Where nobody takes the arm within 30 s it ends as well (off).
class ForceTest {
 public:
  enum class Phase { off, waiting, rising, holding, falling, done, lost };

  // Begins one anew, also while one runs. `most_N` is not bounded here.
  void ask(double most_N);
  void end() { phase_ = Phase::off; }
  // The force [N] along the device's y, upward, for this sample; 0 where none runs. ask(), end()
  // and tick() are one thread's.
  double tick(const HandSample& sample, double period_s);

  // A person has asked for a force, and it is not over.
  static bool runs(Phase phase) { return phase >= Phase::waiting && phase <= Phase::falling; }

  Phase phase() const { return phase_; }
  bool gives() const { return phase_ >= Phase::rising && phase_ <= Phase::falling; }

 private:
  Phase phase_ = Phase::off;
  double most_N_ = 0.0, since_s_ = 0.0;
  HandOnArm hand_;
  Vec3 last_m_{0.0};
  double speed_m_s_ = 0.0;  // over 10 ms
};

}  // namespace trephine
