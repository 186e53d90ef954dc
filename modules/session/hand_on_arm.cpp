#include "session/hand_on_arm.h"

namespace trephine {

bool HandOnArm::takes(const HandSample& sample) {
  constexpr double kMoved_m = 0.005;
  if (sample.no_hand) {
    seen_ = false;
    return false;
  }
  if (!seen_) {
    seen_at_m_ = sample.position_m;
    moved_ = 0;
  }
  seen_ = true;
  moved_ = glm::length(sample.position_m - seen_at_m_) < kMoved_m ? 0 : moved_ + 1;
  by_button_ = sample.button;
  return by_button_ || moved_ >= samples_;
}

}  // namespace trephine
