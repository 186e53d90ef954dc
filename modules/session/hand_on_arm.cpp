#include "session/hand_on_arm.h"

namespace trephine {

bool HandOnArm::takes(const HandSample& sample, double period_s) {
  constexpr double kMoved_m = 0.005, kRest_m_s = 0.05;
  constexpr int kSamples = 20;
  if (sample.no_hand) {
    *this = HandOnArm();
    return false;
  }
  const Vec3 step_m = seen_ ? sample.position_m - last_m_ : Vec3(0.0);
  last_m_ = sample.position_m;
  speed_m_s_ += period_s / (period_s + kSpeedOver_s) * (step_m / period_s - speed_m_s_);
  const double speed_m_s = glm::length(speed_m_s_);
  if (glm::length(step_m) > kMoved_m || speed_m_s > kTooFast_m_s) struck_ = true;
  if (speed_m_s < kRest_m_s) struck_ = false;
  if (!seen_ || struck_) seen_at_m_ = sample.position_m;
  seen_ = true;
  moved_ = glm::length(sample.position_m - seen_at_m_) < kMoved_m ? 0 : moved_ + 1;
  by_button_ = sample.button;
  return by_button_ || moved_ >= kSamples;
}

}  // namespace trephine
