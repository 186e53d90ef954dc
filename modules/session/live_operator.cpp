#include "session/live_operator.h"

#include <algorithm>

namespace trephine {

void LiveOperator::setPoints(std::uint64_t tick, OperatorSetPoint* hands, std::size_t arm_count) {
  if (script_) script_->setPoints(tick, hands, arm_count);
  live_.refresh();
  for (std::size_t arm = 0; arm < arm_count; ++arm) {
    const LiveHands::Hand& hand = live_.value().hands[arm];
    if (hand.live || hand.held || !script_) {
      hands[arm] = {Pose{hand.held ? hand.held_m : hand.position_m, Quat(1, 0, 0, 0)},
                    hand.stiffness_N_per_m, hand.damping_Ns_per_m};
    }
    Release& back = released_[arm];
    if (hand.held) {
      back = {hand.held_m, 0.0};
    } else if (back.share < 1.0) {
      back.share = std::min(1.0, back.share + share_a_tick_);
      Vec3& position_m = hands[arm].pose_m.position;
      position_m = back.from_m + back.share * (position_m - back.from_m);
    }
  }
}

bool LiveOperator::command(std::uint64_t tick, Command& out) {
  return script_ && !live_.value().script_waits && script_->command(tick, out);
}

}  // namespace trephine
