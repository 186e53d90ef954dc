#include "haptics/device_rules.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trephine {

namespace {
constexpr double kCalm_s = 1.0;           // without the error, before force comes back
constexpr double kErrorsWithin_s = 10.0;  // three that begin within it keep the force away
constexpr double kWarmShare = 0.5;
constexpr double kWarming_s = 2.0;  // from all of the force to that share
constexpr double kWarmFrom = 0.8;   // of what the continuous force holds the motors at
}  // namespace

void ErrorRule::tick(bool error, double period_s) {
  last_begin_s_ += period_s;
  begin_before_s_ += period_s;
  since_said_s_ = error ? 0.0 : since_said_s_ + period_s;
  if (error && !said_) {
    kept_ = kept_ || begin_before_s_ <= kErrorsWithin_s;
    begin_before_s_ = last_begin_s_;
    last_begin_s_ = 0.0;
    away_ = true;
  } else if (since_said_s_ >= kCalm_s) {
    away_ = false;
  }
  said_ = error;
}

double WarmthRule::limit_N(double most_N, bool warm, double sent_N, const ArmDynamics& arm,
                           double period_s) {
  const double step = period_s * (1.0 - kWarmShare) / kWarming_s;
  share_ = warm ? std::max(kWarmShare, share_ - step) : std::min(1.0, share_ + step);
  double limit_N = share_ * most_N;
  if (arm.thermal_s > 0.0 && arm.continuous_force_N < most_N) {
    const double load = sent_N / arm.continuous_force_N;
    warmth_ += std::min(1.0, period_s / arm.thermal_s) * (load * load - warmth_);
    const double fallen = std::clamp((warmth_ - kWarmFrom) / (1.0 - kWarmFrom), 0.0, 1.0);
    limit_N = std::min(limit_N, most_N + fallen * (arm.continuous_force_N - most_N));
  }
  limits_ = limit_N < most_N;
  return limit_N;
}

bool SilenceRule::tick(std::uint64_t sequence, double period_s,
                       std::optional<std::int64_t> now_ns) {
  constexpr double kSilent_s = 0.015, kRounding = 1e-9;
  if (sequence != last_ && now_ns) last_ns_ = *now_ns;
  ticks_ = sequence == last_ ? ticks_ + 1 : 0;
  last_ = sequence;
  const bool by_ticks = double(ticks_) * period_s >= kSilent_s - kRounding;
  return by_ticks && (!now_ns || 1e-9 * double(*now_ns - last_ns_) >= kSilent_s);
}

bool HandRule::tick(const Pose& pose_m, bool button, bool lost) {
  constexpr double kMoved_m = 0.005, kTurned_rad = 5.0 * std::numbers::pi / 180.0;
  if (lost) {
    *this = HandRule();
    return false;
  }
  if (held_) return true;
  if (!first_) first_ = pose_m;
  const double moved_m = glm::length(pose_m.position - first_->position);
  const double along = std::abs(glm::dot(pose_m.orientation, first_->orientation));
  held_ = button || moved_m >= kMoved_m || along <= std::cos(0.5 * kTurned_rad);
  return held_;
}

}  // namespace trephine
