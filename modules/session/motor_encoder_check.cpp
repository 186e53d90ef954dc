#include "session/motor_encoder_check.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trephine {

namespace {

constexpr double kSlow_m_s = 0.05, kSlowOver_s = 0.05, kStillPatience_s = 3.0;
constexpr double kGentle_N = 0.8;  // beyond the friction of the arms that we know
constexpr double kFarthest_m = 0.003, kBesideLine_m = 0.008;
constexpr double kLongestHalf_s = 0.04;
constexpr double kRest_s = 0.06;  // between pushes, and more: the hand brings it back
constexpr double kMoreRest_s[] = {0.0, 0.023, 0.011, 0.041, 0.005, 0.031, 0.017, 0.037};
constexpr int kMostBroken = 30;          // pushes that late ticks have broken
constexpr double kLeastMass_kg = 0.002;  // what states less is taken to state nothing
constexpr double kTooNoisySteps = 3.0, kJumpSteps = 20.0;
constexpr int kMostJumps = 3;          // bends: one sample beside the line makes three
constexpr double kBendsOfNoise = 4.8;  // 1.96 times the square root of 1 + 4 + 1

struct Smallest {
  double value;
  Vec3 along;
};

// The smallest eigenvalue of a symmetric matrix, and its axis (Smith 1961, by the angle of its
// characteristic polynomial).
Smallest smallestEigenvalue(const glm::dmat3& a) {
  const double q = (a[0][0] + a[1][1] + a[2][2]) / 3.0;
  double p2 = 0.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double d = a[i][j] - (i == j ? q : 0.0);
      p2 += d * d;
    }
  }
  const double p = std::sqrt(p2 / 6.0);
  if (!(p > 1e-12)) return {q, Vec3(1.0, 0.0, 0.0)};
  const glm::dmat3 b = (a - q * glm::dmat3(1.0)) / p;
  const double r = std::clamp(glm::determinant(b) / 2.0, -1.0, 1.0);
  const double value = q + 2.0 * p * std::cos(std::acos(r) / 3.0 + 2.0 * std::numbers::pi / 3.0);
  const glm::dmat3 rest = a - value * glm::dmat3(1.0);
  Vec3 along(0.0);
  for (int i = 0; i < 3; ++i) {
    const Vec3 across = glm::cross(rest[i], rest[(i + 1) % 3]);
    if (glm::length(across) > glm::length(along)) along = across;
  }
  const double length = glm::length(along);
  return {value, length > 0.0 ? along / length : Vec3(1.0, 0.0, 0.0)};
}

}  // namespace

void MotorEncoderCheck::ask(double mass_kg, double delay_s, double most_N, double patience_s,
                            double step_m) {
  *this = MotorEncoderCheck();
  mass_kg_ = mass_kg;
  delay_s_ = delay_s;
  most_N_ = std::min(kGentle_N, most_N);
  patience_s_ = patience_s;
  step_m_ = std::max(step_m, kLeastStep_m);
  phase_ = Phase::waiting;
}

Vec3 MotorEncoderCheck::tick(const HandSample& sample, bool fresh, bool late, double period_s) {
  if (!runs(phase_)) return Vec3(0.0);
  if (sample.away) {
    phase_ = Phase::lost;
    return Vec3(0.0);
  }
  since_s_ += period_s;
  if (phase_ == Phase::waiting) return wait(sample, period_s);
  if (hand_.letsGo(sample)) {
    phase_ = Phase::lost;
    return Vec3(0.0);
  }
  if (phase_ == Phase::still) takeStill(sample.position_m, fresh);
  sampled_s_ += period_s;
  was_late_ = was_late_ || late;
  if (fresh) {
    if (!was_late_) {
      const Vec3 now_m_s = (sample.position_m - last_m_) / sampled_s_;
      fast_m_s_ += sampled_s_ / (sampled_s_ + HandOnArm::kSpeedOver_s) * (now_m_s - fast_m_s_);
      slow_m_s_ += sampled_s_ / (sampled_s_ + kSlowOver_s) * (now_m_s - slow_m_s_);
    }
    sampled_s_ = 0.0;
    was_late_ = false;
    before_last_m_ = last_m_;
    last_m_ = sample.position_m;
  }
  if (phase_ != Phase::pushing) return Vec3(0.0);
  if (glm::length(fast_m_s_) > HandOnArm::kTooFast_m_s) {
    phase_ = Phase::lost;
    return Vec3(0.0);
  }
  return push(sample.position_m, late, period_s);
}

Vec3 MotorEncoderCheck::wait(const HandSample& sample, double period_s) {
  if (since_s_ > patience_s_) {
    phase_ = Phase::untouched;
    return Vec3(0.0);
  }
  if (!hand_.takes(sample, period_s)) return Vec3(0.0);
  last_m_ = before_last_m_ = sample.position_m;
  since_s_ = 0.0;
  phase_ = Phase::still;
  return Vec3(0.0);
}

// Of an arm that hardly moves; of any, where it does not come to rest: it may only seem to move.
void MotorEncoderCheck::takeStill(const Vec3& at_m, bool fresh) {
  if (!fresh) return;
  const Vec3 bend_m = at_m - 2.0 * last_m_ + before_last_m_;
  const bool in_row = ++seen_ > 2;
  if (!in_row || (glm::length(slow_m_s_) > kSlow_m_s && since_s_ < kStillPatience_s)) return;
  for (int axis = 0; axis < 3; ++axis) {
    bends_m_[std::size_t(axis)][std::size_t(still_)] = std::abs(bend_m[axis]);
  }
  if (++still_ == kStill) judgeStill();
}

void MotorEncoderCheck::judgeStill() {
  for (auto& bends : bends_m_) {
    const auto at = bends.begin() + kStill * 95 / 100;
    std::nth_element(bends.begin(), at, bends.end());
    noise_m_ = std::max(noise_m_, *at / kBendsOfNoise);
    const auto jumps = std::count_if(bends.begin(), bends.end(),
                                     [&](double bend) { return bend > kJumpSteps * step_m_; });
    if (jumps > kMostJumps) {
      noise_m_ = std::max(noise_m_, *std::max_element(bends.begin(), bends.end()) / kBendsOfNoise);
    }
  }
  const bool usable =
      noise_m_ < kTooNoisySteps * step_m_ && mass_kg_ >= kLeastMass_kg && most_N_ > 0.0;
  phase_ = usable ? Phase::pushing : Phase::done;
}

// One push takes `half_` samples each way, and a rest.
Vec3 MotorEncoderCheck::push(const Vec3& at_m, bool late, double period_s) {
  const auto samples = [&](double seconds) { return int(std::lround(seconds / period_s)); };
  if (half_ == 0) {
    const double half_s = std::min(kLongestHalf_s, std::sqrt(kFarthest_m * mass_kg_ / most_N_));
    half_ = std::clamp(samples(half_s), 2, kLongest / 3);
    pushed_ = true;
  }
  const int delay = std::clamp(samples(delay_s_), 0, kLongest / 6);
  const int looked = kBefore + 2 * half_ + delay;
  const int rest = samples(kRest_s + kMoreRest_s[push_ % kTimes]);
  if (late && tick_ > 0 && tick_ < looked) {
    if (++broken_ > kMostBroken) phase_ = Phase::late;
    tick_ = -rest;
    return Vec3(0.0);
  }
  if (tick_ >= 0 && tick_ < looked) {
    path_m_[std::size_t(tick_)] = at_m;
    const Vec3 &first = path_m_[0], &begin = path_m_[std::size_t(std::min(tick_, kBefore - 1))];
    const Vec3 drift_m = (begin - first) / double(kBefore - 1);
    const double after = double(tick_ - (kBefore - 1));
    if (after > 0.0 && glm::length(at_m - begin - after * drift_m) > kBesideLine_m) {
      phase_ = Phase::lost;
      return Vec3(0.0);
    }
  }
  if (++tick_ == looked) judgePush(period_s, delay);
  if (tick_ >= looked + rest) {
    tick_ = 0;
    if (++push_ == 3 * kTimes) {
      judge();
      phase_ = Phase::done;
    }
    return Vec3(0.0);
  }
  const int since = tick_ - kBefore;
  Vec3 force_N(0.0);
  if (since >= 0 && since < 2 * half_) {
    force_N[push_ / kTimes] = (since < half_ ? 1.0 : -1.0) * sign() * most_N_;
  }
  return force_N;
}

// What was seen beside the line on which the arm went before, against what the force alone makes of
// the stated mass from `delay` samples after it was sent.
void MotorEncoderCheck::judgePush(double period_s, int delay) {
  const Vec3& begin_m = path_m_[kBefore - 1];
  const Vec3 drift_m = (begin_m - path_m_[0]) / double(kBefore - 1);  // a sample
  double at_m = 0.0, speed_m_s = 0.0, squares = 0.0;
  Vec3 products(0.0);
  for (int n = 0; n < 2 * half_ + delay; ++n) {
    const int acts = n - delay;  // the force that acted up to this sample
    if (acts >= 0) {
      const double force_N = (acts < half_ ? 1.0 : -1.0) * sign() * most_N_;
      at_m += period_s * speed_m_s + 0.5 * period_s * period_s * force_N / mass_kg_;
      speed_m_s += period_s * force_N / mass_kg_;
    }
    products += at_m * (path_m_[std::size_t(kBefore + n)] - begin_m - double(n + 1) * drift_m);
    squares += at_m * at_m;
  }
  columns_[std::size_t(push_ / kTimes)][std::size_t(push_ % kTimes)] = products / squares;
}

void MotorEncoderCheck::judge() {
  glm::dmat3 r(0.0);  // by columns
  double variance = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& pushes = columns_[std::size_t(axis)];
    for (const Vec3& each : pushes) r[axis] += each / double(kTimes);
    for (const Vec3& each : pushes) {
      const Vec3 off = each - r[axis];
      variance += glm::dot(off, off) / double(9 * kTimes * (kTimes - 1));
    }
  }
  const Smallest least = smallestEigenvalue(0.5 * (r + glm::transpose(r)));
  const double weakest2 = smallestEigenvalue(glm::transpose(r) * r).value;
  response_ = {least.value, least.along, std::sqrt(std::max(0.0, weakest2)), std::sqrt(variance)};
}

}  // namespace trephine
