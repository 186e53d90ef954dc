#include "session/force_test.h"

#include <algorithm>

namespace trephine {

namespace {

constexpr double kRise_s = 3.0, kHold_s = 2.0, kFall_s = 1.0;
constexpr double kPatience_s = 30.0;

}  // namespace

void ForceTest::ask(double most_N) {
  *this = ForceTest();
  most_N_ = most_N;
  phase_ = Phase::waiting;
}

double ForceTest::tick(const HandSample& sample, double period_s) {
  if (!runs(phase_)) return 0.0;
  if (sample.away) {
    phase_ = Phase::lost;
    return 0.0;
  }
  since_s_ += period_s;
  if (phase_ == Phase::waiting) {
    if (since_s_ > kPatience_s) {
      phase_ = Phase::off;
    } else if (hand_.takes(sample, period_s)) {
      phase_ = Phase::rising;
      since_s_ = 0.0;
      last_m_ = sample.position_m;
    }
    return 0.0;
  }
  if (hand_.letsGo(sample)) {
    phase_ = Phase::done;
    return 0.0;
  }
  const double share = period_s / (period_s + HandOnArm::kSpeedOver_s);
  speed_m_s_ += share * (glm::length(sample.position_m - last_m_) / period_s - speed_m_s_);
  last_m_ = sample.position_m;
  if (speed_m_s_ > HandOnArm::kTooFast_m_s) {
    phase_ = Phase::lost;
    return 0.0;
  }
  const double falling_s = since_s_ - kRise_s - kHold_s;
  if (falling_s >= kFall_s) {
    phase_ = Phase::done;
    return 0.0;
  }
  phase_ = since_s_ < kRise_s ? Phase::rising : falling_s < 0.0 ? Phase::holding : Phase::falling;
  return most_N_ * std::min({1.0, since_s_ / kRise_s, 1.0 - std::max(0.0, falling_s) / kFall_s});
}

}  // namespace trephine
