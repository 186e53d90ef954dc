#include "session/live_operator.h"

#include <algorithm>

#include "device/trephine_device.h"
#include "haptics/loop_clock.h"

namespace trephine {

namespace {

constexpr double kTurn_s = 0.02;  // of each of the two delays with which a turn is begun and ended

// A share of the turn from one rotation to another that is near.
Quat towards(const Quat& from, const Quat& to, double share) {
  const Quat near = glm::dot(from, to) < 0.0 ? -to : to;
  return glm::normalize(from * (1.0 - share) + near * share);
}

}  // namespace

void LiveOperator::setPoints(std::uint64_t tick, OperatorSetPoint* hands, std::size_t arm_count) {
  if (script_) script_->setPoints(tick, hands, arm_count);
  live_.refresh();
  for (std::size_t arm = 0; arm < arm_count; ++arm) {
    const LiveHands::Hand& hand = live_.value().hands[arm];
    turn(pointers_[arm], hand.turned);
    if (hand.live || hand.held || !script_) {
      hands[arm] = {Pose{hand.held ? hand.held_m : hand.position_m, pointers_[arm].turned},
                    hand.stiffness_N_per_m, hand.damping_Ns_per_m};
    }
    Release& back = released_[arm];
    if (hand.pointed && point(tick, arm, hand.held, hands[arm])) {
      back.share = 1.0;  // it begins where its arm is
    } else if (hand.held) {
      back = {hand.held_m, 0.0};
    } else if (back.share < 1.0) {
      back.share = std::min(1.0, back.share + share_a_tick_);
      Vec3& position_m = hands[arm].pose_m.position;
      position_m = back.from_m + back.share * (position_m - back.from_m);
    }
    if (pointers_[arm].in_use && !hand.pointed) {
      pointers_[arm].path.forget();
      pointers_[arm].hand.forget();
    }
    pointers_[arm].in_use = hand.pointed;
  }
}

// In a pause the path goes on and the hand stays. False before the pointer's first sample.
bool LiveOperator::point(std::uint64_t tick, std::size_t arm, bool held, OperatorSetPoint& hand) {
  Pointer& pointer = pointers_[arm];
  if (!pointer.seen) return false;
  const auto period_ns = std::int64_t(period_s_ * 1e9 + 0.5);
  const std::int64_t now_ns = host_clock_ ? HostClock().now_ns() : std::int64_t(tick) * period_ns;
  double depth_mm = 0.0;
  if (const PointerInput* at = pointer.path.at()) {
    depth_mm = glm::dot(pointer.last.patient_position_mm - at->at.origin_mm, at->at.direction);
  }
  pointer.path.advance(now_ns, period_ns, depth_mm);
  const PointerInput* to = pointer.path.at();
  if (!to) return false;
  if (held) {
    pointer.hand.forget();
    return true;
  }
  hand.pose_m.position =
      pointer.hand.rest_m(*to, pointer.last, pointer.map, pointer.reach, period_s_);
  hand.stiffness_N_per_m = PointerHand::kStiffness_N_per_m;
  hand.damping_Ns_per_m = PointerHand::kDamping_Ns_per_m;
  return true;
}

void LiveOperator::turn(Pointer& pointer, const Quat& to) const {
  if (pointer.turned == to) return;
  const double share = std::min(1.0, period_s_ / kTurn_s);
  pointer.turning = towards(pointer.turning, to, share);
  pointer.turned = towards(pointer.turned, pointer.turning, share);
}

bool LiveOperator::command(std::uint64_t tick, Command& out) {
  return script_ && !live_.value().script_waits && script_->command(tick, out);
}

void LiveOperator::moved(const TickRecord& record, const HapticParameters& parameters) {
  for (std::size_t arm = 0; arm < parameters.arms.size(); ++arm) {
    Pointer& pointer = pointers_[arm];
    pointer.map = parameters.arms[arm].map;
    const ArmRecord& now = record.arms[arm];
    if (now.flags & TREPHINE_ARM_LOST || !isFinite(now.device_position_m)) continue;
    pointer.last = now;
    pointer.seen = true;
  }
}

}  // namespace trephine
