#include "session/hand_on_arm.h"

namespace trephine {

bool HandOnArm::takes(const HandSample& sample, double period_s) {
  constexpr double kMoved_m = 0.005, kRest_m = 0.002, kRestFor_s = 0.5, kMeanOver_s = 0.05,
                   kBlowOver_s = 0.004;
  constexpr int kSamples = 20;
  if (sample.no_hand) {
    *this = HandOnArm();
    return false;
  }
  const Vec3 step_m = seen_ ? sample.position_m - last_m_ : Vec3(0.0);
  last_m_ = sample.position_m;
  // In two steps: an encoder that scatters by a millimetre has little speed by that.
  rough_m_s_ += period_s / (period_s + kBlowOver_s) * (step_m / period_s - rough_m_s_);
  speed_m_s_ += period_s / (period_s + kBlowOver_s) * (rough_m_s_ - speed_m_s_);
  if (glm::length(speed_m_s_) > kTooFast_m_s) {
    struck_ = true;
    rested_s_ = 0.0;
  }
  // An arm that swings back stands for a moment, which is no rest.
  mean_m_ = seen_ ? mean_m_ + period_s / (period_s + kMeanOver_s) * (sample.position_m - mean_m_)
                  : sample.position_m;
  rested_s_ += period_s;
  if (glm::length(mean_m_ - rest_m_) > kRest_m) {
    rest_m_ = mean_m_;
    rested_s_ = 0.0;
  }
  if (rested_s_ >= kRestFor_s) struck_ = false;
  if (!seen_ || struck_ || glm::length(step_m) > kMoved_m) seen_at_m_ = sample.position_m;
  seen_ = true;
  moved_ = glm::length(sample.position_m - seen_at_m_) < kMoved_m ? 0 : moved_ + 1;
  by_button_ = sample.button;
  return by_button_ || moved_ >= kSamples;
}

}  // namespace trephine
