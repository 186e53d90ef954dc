// Whether an arm answers forces as its stated mass and delay say. The force is known and the motion
// is sampled, so both can be found in the first milliseconds of a contact, when the force is new and
// the hand has not answered yet.
#pragma once

#include <array>

#include "haptics/arm_dynamics.h"
#include "haptics/arm_estimator.h"

namespace trephine {

// By linearity the sample's surprise, on an arm that is g times lighter than stated and answers j
// samples later, is g a(n - j) - a(n) and noise, where a is what the force alone would have changed
// in the expected sample of an arm as stated (the estimator's own equations, driven by the force
// and corrected by its own gains). The surprise is the sample less the expected one. So with y =
// surprise + a, least squares give
//   g   = sum y(n) a(n) / sum a(n)^2
// and a delay is found where sum (y(n) - a(n - j))^2 is less for j = 1 or -1 than for 0, by more
// than noise makes and with most of y explained. A firm hand makes g smaller than 1: within the
// delay it holds the arm back. The noise is the encoder's, or 8 times the mean square surprise in
// air just before (5 ms), if that is more: a hand that changed its force fast in air does so in
// contact. (Prediction-error identification: Ljung 1999.)
class ArmCheck {
 public:
  ArmCheck(const ArmDynamics& stated, const ArmEstimator& estimator, double period_s);

  // After `estimator` took a sample, before which `held_N` acted. True where what is known of the
  // arm may have changed: in air and as a contact begins. `skew_N`: as the estimator takes it.
  bool look(const ArmEstimator& estimator, const Vec3& held_N, bool touching,
            const Vec3& skew_N = Vec3(0.0));
  // After samples were left out: what was found of the arm stays.
  void forget();

  // Stated mass / mass found, 1 to 5. Not below 1: a heavier arm answers as one that a hand holds.
  double lighter() const { return lighter_; }
  // As stated, or one more or less; 0 to kMaxDelayTicks, whatever was stated.
  double delaySamples() const;
  double handShare() const { return hand_share_; }  // 0: the arm answers as if free; 1: not at all
  // True from when it was sure that mass or delay is not as stated.
  bool notAsStated() const { return not_as_stated_; }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.more_samples_, self.x_, self.v_, self.a_);
    archive(self.last_answer_m_, self.last_y_m_, self.since_air_s_, self.in_air_m2_);
    archive(self.aa_, self.aa_before_, self.yy_, self.noise_);
    archive(self.ya_, self.ya_before_, self.ya_after_);
    archive(self.lighter_, self.not_as_stated_);
  }

 private:
  void judgeDelay();

  double T_, stated_kg_, variance_m2_;
  double stated_samples_;
  int more_samples_ = 0;           // that were found: -1, 0 or 1
  Vec3 x_{0.0}, v_{0.0}, a_{0.0};  // the arm's answer to the forces alone: m, m/s, m/s2
  Vec3 last_answer_m_{0.0}, last_y_m_{0.0};
  double since_air_s_ = 1e9;
  double in_air_m2_ = 0.0;  // mean square of the surprise in air, leaky
  // Sums over the first 12.5 ms of contacts, in variances of the noise there: a a, the same a
  // sample earlier, y y and the noise in it; y a with a as it is, a sample earlier and a sample
  // later.
  double aa_ = 0.0, aa_before_ = 0.0, yy_ = 0.0, noise_ = 0.0;
  double ya_ = 0.0, ya_before_ = 0.0, ya_after_ = 0.0;
  double lighter_ = 1.0, hand_share_ = 0.0;
  bool not_as_stated_ = false;
};

}  // namespace trephine
