#include "session/pointer_hand.h"

#include <algorithm>

namespace trephine {

namespace {

constexpr double kPerNewton_mm_s = 15.0;  // of push that nothing answers
constexpr double kOut_mm_s = 60.0, kOut_N = 2.0;
constexpr double kHover_mm_s = 100.0, kHover_s = 0.1;
constexpr double kAside_mm_s = 60.0;  // across the ray per N that is left, where it touches
constexpr double kLeastAside_N = 0.5;
constexpr double kBelow_mm = 2.0;      // of where it hovers: aside of it there may be tissue
constexpr double kElsewhere_mm = 3.0;  // so far aside a pointer wants the tool out first
constexpr double kRelax_s = 0.05, kGiveIn_s = 0.02;
// From the tool to the rest point at most: short of what lets a hooked tool go.
constexpr double kFarthest_mm = 12.0;
constexpr double kLeastSlope =
    0.3;  // of the ray to the tool: flatter, and it presses along the ray

}  // namespace

// As far as a hand that pushes by `push_N` goes, or is pushed back.
void PointerHand::press(Way& way, double push_N, double T) const {
  const double speed =
      std::clamp(kPerNewton_mm_s * (push_N - way.pull_N()), -kOut_mm_s, kPress_mm_s);
  const double touched_mm = way.touched_mm.value_or(way.arm_mm);
  const double end_mm = std::max(way.seen_mm.value_or(touched_mm), touched_mm) + kReach_mm;
  const double step_mm = speed * T;
  way.rest_mm += step_mm > 0.0 ? std::clamp(end_mm - way.rest_mm, 0.0, step_mm) : step_mm;
}

// Backwards, unless something keeps it in.
void PointerHand::comeOut(Way& way, double target_mm, double T) const {
  const double speed = std::clamp(kPerNewton_mm_s * 2.0 * (kOut_N + way.pull_N()), 0.0, kOut_mm_s);
  way.rest_mm -= std::clamp(way.rest_mm - target_mm, 0.0, speed * T);
}

double PointerHand::hoverAt_mm(const Way& way) {
  return std::min(way.seen_mm.value_or(way.rest_mm), 0.0) - kHover_mm;
}

void PointerHand::hover(Way& way, double T) const {
  if (!way.seen_mm) return;
  const double step_mm = (hoverAt_mm(way) - way.rest_mm) * std::min(1.0, T / kHover_s);
  if (step_mm < 0.0) return comeOut(way, way.rest_mm + step_mm, T);
  if (!plane_mm_) way.rest_mm += std::min(kHover_mm_s * T, step_mm);  // else it has come out here
}

void PointerHand::goAside(Way& way, double push_N, double most_N, double T) const {
  const double apart_mm = glm::length(way.aside_mm);
  const Vec3 pull_N = (way.aside_mm - way.arm_aside_mm) / way.mm_per_N;
  double step_mm = PointerPath::kFastest_mm_s * T;
  if (way.touches) {
    const double left_N =
        std::max(kLeastAside_N, std::sqrt(std::max(0.0, most_N * most_N - push_N * push_N)));
    const double along_N = apart_mm > 0.0 ? -glm::dot(pull_N, way.aside_mm) / apart_mm : 0.0;
    step_mm = std::min(step_mm, kAside_mm_s * T * std::max(0.0, left_N - along_N));
    const double size_N = glm::length(pull_N);
    if (size_N > left_N) {
      way.aside_mm -=
          pull_N * ((1.0 - left_N / size_N) * std::min(1.0, T / kGiveIn_s) * way.mm_per_N);
    }
  }
  way.aside_mm *= apart_mm > step_mm ? 1.0 - step_mm / apart_mm : 0.0;
}

// Where the pointer is, on the plane across the tool. A hole that is being made is not followed
// down: from a push, or a touch of tissue that is not seen, to where the pointer next goes
// elsewhere it is the plane on which that began.
Vec3 PointerHand::onPlane(const PointerSample& at, const Vec3& along, const ArmRecord& arm,
                          bool presses, bool touches) {
  const double slope = glm::dot(at.direction, along);
  const auto pointed = [&](const Vec3& place_mm) {
    return at.origin_mm + (glm::dot(place_mm - at.origin_mm, along) / slope) * at.direction;
  };
  const bool left = plane_mm_ && !presses && !touches &&
                    glm::distance(pointed(*plane_mm_), pressed_mm_) > kElsewhere_mm;
  if (left) plane_mm_.reset();
  const Vec3 place_mm = plane_mm_.value_or(seen_mm_.value_or(arm.proxy_position_mm));
  if (presses || (touches && !plane_mm_)) {
    plane_mm_ = place_mm;
    pressed_mm_ = pointed(place_mm);
  }
  return pointed(place_mm);
}

Vec3 PointerHand::rest_m(const PointerInput& to, const ArmRecord& arm, const WorkspaceMap& map,
                         const Reach& reach, double T) {
  if (!rest_m_) rest_m_ = arm.device_position_m;
  if (arm.tool_state & kToolClutched) return *rest_m_;
  const Vec3 arm_mm = map.toPatient_mm({arm.device_position_m, Quat(1, 0, 0, 0)}).position;
  const Vec3 rest_mm = map.toPatient_mm({*rest_m_, Quat(1, 0, 0, 0)}).position;
  const bool waits = (arm.tool_state & kToolWaits) != 0;
  const bool touches = waits || arm.tissue_class >= 0 || (arm.tool_state & kToolHeld);
  const bool presses = to.push_N > 0.0 && !to.put_down && !waits;
  if (to.at.depth_mm) seen_mm_ = to.at.origin_mm + *to.at.depth_mm * to.at.direction;
  if (touches || (presses && !pressing_)) touched_mm_ = arm.proxy_position_mm;
  pressing_ = presses;

  Vec3 along = map.rotation * arm.device_orientation * Vec3(0.0, 0.0, -1.0);
  if (glm::dot(along, to.at.direction) < kLeastSlope) along = to.at.direction;
  const Vec3 origin_mm = onPlane(to.at, along, arm, presses, touches);
  const auto depthOf = [&](const std::optional<Vec3>& place_mm) {
    return place_mm ? std::optional(glm::dot(*place_mm - origin_mm, along)) : std::nullopt;
  };
  Way way;
  way.arm_mm = *depthOf(arm_mm);
  way.rest_mm = *depthOf(rest_mm);
  way.arm_aside_mm = arm_mm - origin_mm - way.arm_mm * along;
  way.aside_mm = rest_mm - origin_mm - way.rest_mm * along;
  way.mm_per_N = 1000.0 * map.motion_scale / kStiffness_N_per_m;
  way.seen_mm = depthOf(seen_mm_);
  way.touched_mm = depthOf(touched_mm_);
  way.touches = touches;

  const double relaxes = std::min(1.0, T / kRelax_s);  // the hand, to where its arm is
  if (presses) {
    press(way, to.push_N, T);
  } else if (waits || (touches && !to.put_down)) {
    comeOut(way, way.rest_mm - kHover_mm, T);
  } else if (to.put_down) {
    way.rest_mm += (way.arm_mm - way.rest_mm) * relaxes;
  } else {
    hover(way, T);
  }
  const bool below = way.seen_mm && way.arm_mm > hoverAt_mm(way) + kBelow_mm;
  if (presses || (!to.put_down && !touches && !below)) {
    goAside(way, presses ? to.push_N : 0.0, kMostShare * reach.max_force_N, T);
  } else {
    way.aside_mm += (way.arm_aside_mm - way.aside_mm) * relaxes;
  }

  Vec3 now_mm = origin_mm + way.rest_mm * along + way.aside_mm;
  const Vec3 from_tool_mm = now_mm - arm.proxy_position_mm;
  const double far_mm = glm::length(from_tool_mm);
  if (far_mm > kFarthest_mm) {
    now_mm = arm.proxy_position_mm + from_tool_mm * (kFarthest_mm / far_mm);
  }
  const Vec3 half_m = 0.5 * reach.workspace_m;
  rest_m_ = glm::clamp(map.toDevice_m(now_mm), -half_m, half_m);
  return *rest_m_;
}

}  // namespace trephine
