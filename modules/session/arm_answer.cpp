#include "session/arm_answer.h"

#include <algorithm>
#include <cmath>

namespace trephine {

namespace {

constexpr double kMoved_m = 0.005;
constexpr double kGentle_N = 0.8;  // beyond the friction of the arms that we know
constexpr double kFarthest_m = 0.003;
constexpr double kLongestHalf_s = 0.04;
constexpr double kRest_s = 0.06;      // between pushes: the hand brings it back
constexpr double kTooNoisy_m = 1e-3;  // beyond it no force: it does not say where it is
constexpr double kTooNoisySteps = 20.0;
constexpr double kBendsOfNoise = 4.8;  // 1.96 times the square root of 1 + 4 + 1

}  // namespace

void ArmAnswer::ask(double mass_kg, double delay_s, double most_N, double patience_s,
                    double step_m) {
  *this = ArmAnswer();
  mass_kg_ = mass_kg;
  delay_s_ = delay_s;
  most_N_ = std::min(kGentle_N, most_N);
  patience_s_ = patience_s;
  step_m_ = step_m;
  phase_ = Phase::waiting;
}

Vec3 ArmAnswer::tick(const ForceTest::Sample& sample, bool fresh, double period_s) {
  if (!runs(phase_)) return Vec3(0.0);
  if (sample.away) {
    phase_ = Phase::lost;
    return Vec3(0.0);
  }
  since_s_ += period_s;
  if (phase_ == Phase::waiting) {
    if (since_s_ > patience_s_) phase_ = Phase::untouched;
    if (sample.no_hand) placed_ = false;
    if (sample.no_hand || phase_ == Phase::untouched) return Vec3(0.0);
    if (!placed_) asked_at_m_ = sample.position_m;
    placed_ = true;
    if (!sample.button && glm::length(sample.position_m - asked_at_m_) < kMoved_m) return Vec3(0.0);
    by_button_ = sample.button;
    phase_ = Phase::still;
    return Vec3(0.0);
  }
  if (sample.no_hand || (by_button_ && !sample.button)) {  // it was let go of
    phase_ = Phase::lost;
    return Vec3(0.0);
  }
  if (phase_ == Phase::still) {
    takeStill(sample.position_m, fresh);
    return Vec3(0.0);
  }
  return push(sample.position_m, period_s);
}

void ArmAnswer::takeStill(const Vec3& at_m, bool fresh) {
  if (!fresh) return;
  if (still_ >= 2) {
    for (int axis = 0; axis < 3; ++axis) {
      bends_m_[std::size_t(axis)][std::size_t(still_ - 2)] =
          std::abs(at_m[axis] - 2.0 * last_m_[axis] + before_last_m_[axis]);
    }
  }
  before_last_m_ = last_m_;
  last_m_ = at_m;
  if (++still_ < kStill + 2) return;
  for (auto& bends : bends_m_) {
    const auto at = bends.begin() + kStill * 95 / 100;
    std::nth_element(bends.begin(), at, bends.end());
    noise_m_ = std::max(noise_m_, *at / kBendsOfNoise);
  }
  const bool usable =
      noise_m_ < std::max(kTooNoisy_m, kTooNoisySteps * step_m_) && mass_kg_ > 0.0 && most_N_ > 0.0;
  phase_ = usable ? Phase::pushing : Phase::done;
}

// One push takes `half_` samples each way, and a rest.
Vec3 ArmAnswer::push(const Vec3& at_m, double period_s) {
  if (half_ == 0) {
    const double half_s = std::min(kLongestHalf_s, std::sqrt(kFarthest_m * mass_kg_ / most_N_));
    half_ = std::clamp(int(std::lround(half_s / period_s)), 2, kLongest / 3);
    pushed_ = true;
  }
  const int late = std::clamp(int(std::lround(delay_s_ / period_s)), 0, kLongest / 6);
  const int seen = 2 * half_ + late;  // samples that are looked at
  const int rest = int(std::lround(kRest_s / period_s));
  const int axis = push_ / 4;
  if (tick_ < kBefore + seen) along_m_[std::size_t(tick_)] = at_m[axis];
  if (++tick_ == kBefore + seen) judge(period_s, late);
  if (tick_ >= kBefore + seen + rest) {
    tick_ = 0;
    if (++push_ < kPushes) return Vec3(0.0);
    for (std::size_t i = 0; i < 3; ++i) shares_[i] = ya_[i] / aa_[i];
    phase_ = Phase::done;
    return Vec3(0.0);
  }
  const int since = tick_ - kBefore;
  Vec3 force_N(0.0);
  if (since >= 0 && since < 2 * half_) {
    force_N[axis] = (since < half_ ? 1.0 : -1.0) * sign() * most_N_;
  }
  return force_N;
}

// What was seen beside the line on which the arm went before, against what the force alone makes of
// the stated mass from `delay_s` after it was sent.
void ArmAnswer::judge(double period_s, int late) {
  const auto axis = std::size_t(push_ / 4);
  const double begin_m = along_m_[kBefore - 1];
  const double drift_m = (begin_m - along_m_[0]) / double(kBefore - 1);  // a sample
  double at_m = 0.0, speed_m_s = 0.0;
  for (int n = 0; n < 2 * half_ + late; ++n) {
    const int acts = n - late;  // the force that acted up to this sample
    if (acts >= 0) {
      const double force_N = (acts < half_ ? 1.0 : -1.0) * sign() * most_N_;
      at_m += period_s * speed_m_s + 0.5 * period_s * period_s * force_N / mass_kg_;
      speed_m_s += period_s * force_N / mass_kg_;
    }
    const double seen_m = along_m_[std::size_t(kBefore + n)] - begin_m - double(n + 1) * drift_m;
    ya_[axis] += seen_m * at_m;
    aa_[axis] += at_m * at_m;
  }
}

}  // namespace trephine
