// The hands of a session's arms, as the window moves them.
#include <algorithm>
#include <cmath>

#include "session/hand_start.h"
#include "session/session_engine.h"

namespace trephine {

void Session::beginOutside() {
  std::vector<double> reach_mm;
  for (std::size_t i = 0; i < exercise_.arms.size(); ++i) {
    const double scale = exercise_.arms[i].map.fixed.value_or(WorkspaceMap{}).motion_scale;
    reach_mm.push_back(1000.0 * scale * capabilities_[i].workspace_m[2] / 2.0);
  }
  const std::vector<double> back_mm = drawnBack_mm(core_->parameters(), *grid_, reach_mm);
  for (const LoopDevice& d : loop_->devices()) {
    if (!d.device->takesTargets()) continue;  // a real arm is where it is
    for (std::size_t i : d.arms) {
      const double scale = exercise_.arms[i].map.fixed.value_or(WorkspaceMap{}).motion_scale;
      begin_m_[i] = Vec3(0.0, 0.0, back_mm[i] / (1000.0 * scale));
      hands_.hands[i].live = true;
      hands_.hands[i].position_m = *begin_m_[i];
    }
  }
  engine_->live_hands.write(hands_);
}

void Session::holdHands(bool hold) {
  const LoopState& now = state();
  if (now.ticks == 0) return;  // nobody has looked where the arms are
  for (std::size_t i = 0; i < exercise_.arms.size(); ++i) {
    LiveHands::Hand& hand = hands_.hands[i];
    if (hold && !hand.held) hand.held_m = now.record.arms[i].device_position_m;
    hand.held = hold;
  }
  engine_->live_hands.write(hands_);
}

void Session::moveHand(std::size_t arm, const Vec3& by_mm) {
  if (hands_.hands[arm].held || state().paused) return;
  const WorkspaceMap map = this->map(arm);
  LiveHands::Hand& hand = hands_.hands[arm];
  if (!hand.live || hand.pointed) {  // taken over from a script, from rest, or from the pointer
    hand.live = true;
    hand.pointed = false;
    hand.position_m = state().record.arms[arm].device_position_m;
  }
  hand.position_m += glm::conjugate(map.rotation) * by_mm / (1000.0 * map.motion_scale);
  for (int axis = 0; axis < 3; ++axis) {
    const double half_m = capabilities_[arm].workspace_m[axis] / 2.0;
    hand.position_m[axis] = std::clamp(hand.position_m[axis], -half_m, half_m);
  }
  engine_->live_hands.write(hands_);
}

Vec3 Session::handTarget_mm(std::size_t arm) const {
  const LiveHands::Hand& hand = hands_.hands[arm];
  const LoopState& now = loop_->state().value();
  const Vec3 at_m = hand.pointed ? now.record.arms[arm].device_position_m : hand.position_m;
  return map(arm).toPatient_mm({at_m, Quat(1, 0, 0, 0)}).position;
}

WorkspaceMap Session::map(std::size_t arm) const {
  const LoopState& now = loop_->state().value();
  return now.ticks > 0 ? now.maps[arm] : exercise_.arms[arm].map.fixed.value_or(WorkspaceMap{});
}

bool Session::clutch(std::size_t arm, bool on, const Quat& rotation) {
  const double length = glm::length(rotation);
  if (!(length > 0.0) || !isFinite(length)) return false;
  const CommandKind kind = on ? CommandKind::clutch_on : CommandKind::clutch_off;
  return loop_->commands().push({kind, 1, {}, std::int32_t(arm), rotation / length});
}

bool Session::clutch(std::size_t arm, bool on) {
  const CommandKind kind = on ? CommandKind::clutch_on : CommandKind::clutch_off;
  return loop_->commands().push({kind, 0, {}, std::int32_t(arm)});
}

bool Session::recentre(std::size_t arm) {
  const bool goes_back = begin_m_[arm].has_value();
  if (!loop_->commands().push({CommandKind::recentre, goes_back, {}, std::int32_t(arm)})) {
    return false;
  }
  if (goes_back) {
    push_N_[arm] = 0.0;
    LiveHands::Hand& hand = hands_.hands[arm];
    hand.live = true;
    hand.pointed = false;
    hand.position_m = *begin_m_[arm];
    hand.turned = Quat(1, 0, 0, 0);
    engine_->live_hands.write(hands_);
  }
  return true;
}

bool Session::changeTool(std::size_t arm, std::size_t tool) {
  if (arm >= exercise_.arms.size() || !exercise_.toolOf(arm, tool)) return false;
  return loop_->commands().push({CommandKind::tool, std::int32_t(tool), {}, std::int32_t(arm)});
}

double Session::mostPush_N(std::size_t arm) const {
  return PointerHand::kMostShare * exercise_.arms[arm].max_force_N;
}

bool Session::point(std::size_t arm, const PointerSample& sample) {
  const double length = glm::length(sample.direction);
  const bool ray = isFinite(sample.origin_mm) && isFinite(length) && length > 0.0 &&
                   isFinite(sample.depth_mm.value_or(0.0));
  if (!ray || !simulated_[arm]) return false;
  std::optional<PointerSample>& last = pointer_[arm];
  const std::int64_t after_ns = last ? last->time_ns : sample.time_ns;
  last = sample;
  last->direction /= length;
  last->time_ns = std::max(sample.time_ns, after_ns);
  LiveHands::Hand& hand = hands_.hands[arm];
  if (!hand.pointed) {
    hand.live = hand.pointed = true;
    engine_->live_hands.write(hands_);
  }
  return playPointer(arm, last->time_ns, false);
}

std::int64_t Session::now_ns() const {
  if (running_ && !stepped_) return HostClock().now_ns();
  return std::int64_t(double(loop_->ticks()) * 1e9 / exercise_.rate_hz);
}

// The last sample once more, at this time.
bool Session::playPointer(std::size_t arm, std::int64_t time_ns, bool put_down) {
  if (!pointer_[arm] || !hands_.hands[arm].pointed) return false;
  PointerSample& at = *pointer_[arm];
  if (time_ns == kNow || (running_ && !stepped_ && time_ns > now_ns())) time_ns = now_ns();
  at.time_ns = std::max(at.time_ns, time_ns);
  return engine_->oper.path(arm).push({at, push_N_[arm], put_down});
}

bool Session::setPush(std::size_t arm, double push_N, std::int64_t time_ns) {
  push_N_[arm] = push_N > 0.0 ? std::min(push_N, mostPush_N(arm)) : 0.0;
  return playPointer(arm, time_ns, false);
}

bool Session::releaseHand(std::size_t arm, std::int64_t time_ns) {
  push_N_[arm] = 0.0;
  return playPointer(arm, time_ns, true);
}

// Tissue comes back around the tools: they come out, and stay there.
void Session::stopPushing() {
  for (std::size_t i = 0; i < exercise_.arms.size(); ++i) {
    if (push_N_[i] > 0.0) (void)setPush(i, 0.0);
  }
}

void Session::turnHand(std::size_t arm, const Vec3& axis, double by_rad) {
  const double length = glm::length(axis);
  if (!(length > 0.0) || !isFinite(length) || !isFinite(by_rad)) return;
  LiveHands::Hand& hand = hands_.hands[arm];
  const Vec3 of_device = glm::conjugate(map(arm).rotation) * axis / length;
  const Quat turned = glm::normalize(glm::angleAxis(by_rad, of_device) * hand.turned);
  if (2.0 * std::acos(std::min(1.0, std::abs(turned.w))) > kMostTurn_rad) return;
  hand.turned = turned;
  engine_->live_hands.write(hands_);
}

void Session::straightenHand(std::size_t arm) {
  hands_.hands[arm].turned = Quat(1, 0, 0, 0);
  engine_->live_hands.write(hands_);
}

}  // namespace trephine
