#include "lab/trades/trade_velocity.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "haptics/arm_estimator.h"
#include "lab/trades/trade_arm.h"
#include "lab/trades/trade_knobs.h"

namespace trephine {

namespace {

constexpr double kPeriod_s = 1e-3;
constexpr int kFine = 10;  // steps of the simulation in a period
constexpr double kMostLag_s = 0.05;

// Where the hand wants to be: at rest, then at 2 mm/s, then to and fro at up to 190 mm/s.
double rest_m(double part) {
  if (part < 0.25) return 0.0;
  const double slow_m = 2e-3 * 2.0 * (std::min(part, 0.55) - 0.25);
  if (part < 0.55) return slow_m;
  const double phase = (part - 0.55) / 0.45;
  return slow_m + 15e-3 * (1.0 - std::cos(2.0 * std::numbers::pi * 2.0 * phase));
}

struct Motion {
  std::vector<double> samples_m;  // of the encoder, one a period
  std::vector<double> true_m_s;   // at the same times
  std::vector<double> fine_m_s;   // one a step of the simulation
};

Motion simulate(double duration_s) {
  Motion out;
  ArmInHand arm;
  const double h = kPeriod_s / kFine;
  const auto steps = std::size_t(std::llround(duration_s / h));
  for (std::size_t n = 0; n < steps; ++n) {
    if (n % kFine == 0) {
      out.samples_m.push_back(arm.reading_m().x);
      out.true_m_s.push_back(arm.velocity_m_s.x);
    }
    out.fine_m_s.push_back(arm.velocity_m_s.x);
    arm.step(Vec3(0.0), Vec3(rest_m(double(n) / double(steps)), 0.0, 0.0), h);
  }
  return out;
}

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += (a[n] - b[n]) * (a[n] - b[n]);
  return a.empty() ? 0.0 : std::sqrt(sum / double(a.size()));
}

}  // namespace

double BackwardDifference::update(double sample_m) {
  const double moved_m = started_ ? sample_m - last_m_ : 0.0;
  started_ = true;
  last_m_ = sample_m;
  return moved_m / period_s_;
}

LowPassDifference::LowPassDifference(double period_s, double cutoff_hz)
    : difference_(period_s), share_(period_s / (period_s + 0.5 / (std::numbers::pi * cutoff_hz))) {}

double LowPassDifference::update(double sample_m) {
  filtered_m_s_ += share_ * (difference_.update(sample_m) - filtered_m_s_);
  return filtered_m_s_;
}

double AdaptiveWindow::update(double sample_m) {
  samples_m_.push_front(sample_m);
  if (samples_m_.size() > kMost + 1) samples_m_.pop_back();
  double slope_m = 0.0;  // a period
  for (std::size_t window = 1; window < samples_m_.size(); ++window) {
    const double tried_m = (sample_m - samples_m_[window]) / double(window);
    bool fits = true;
    for (std::size_t i = 1; i < window && fits; ++i) {
      // Rounding must not decide about a sample on the band's edge.
      fits = std::abs(samples_m_[i] - (sample_m - double(i) * tried_m)) <= band_m_ * (1.0 + 1e-9);
    }
    if (!fits) break;
    slope_m = tried_m;
  }
  return slope_m / period_s_;
}

double lagOf(const std::vector<double>& estimate, double period_s, const std::vector<double>& truth,
             double fine_s, double most_s) {
  const auto per_period = std::size_t(std::llround(period_s / fine_s));
  const auto most = std::size_t(std::llround(most_s / fine_s));
  const std::size_t first = (most + per_period - 1) / per_period;
  double least = 0.0;
  std::size_t best = 0;
  for (std::size_t shift = 0; shift <= most; ++shift) {
    double sum = 0.0;
    for (std::size_t n = first; n < estimate.size() && n * per_period < truth.size(); ++n) {
      const double off = estimate[n] - truth[n * per_period - shift];
      sum += off * off;
    }
    if (shift == 0 || sum < least) {
      least = sum;
      best = shift;
    }
  }
  return double(best) * fine_s;
}

TradeRows tradeVelocity(const TradesOptions& options, const Progress& progress) {
  const Motion motion = simulate(options.stroke_s);
  const ArmInHand arm;
  BackwardDifference difference(kPeriod_s);
  LowPassDifference fast(kPeriod_s, 100.0), slow(kPeriod_s, 20.0);
  AdaptiveWindow window(kPeriod_s, arm.encoder_m);
  ArmDynamics dynamics;
  dynamics.apparent_mass_kg = arm.mass_kg;
  dynamics.encoder_step_m = arm.encoder_m;
  ArmEstimator kalman(dynamics, kPeriod_s);
  const std::vector<std::pair<const char*, std::function<double(double)>>> estimates{
      {"backward difference", [&](double x) { return difference.update(x); }},
      {"low-pass 100 Hz", [&](double x) { return fast.update(x); }},
      {"low-pass 20 Hz", [&](double x) { return slow.update(x); }},
      {"adaptive window", [&](double x) { return window.update(x); }},
      {"kalman", [&](double x) {
         kalman.update(Vec3(x, 0.0, 0.0), Vec3(0.0));
         return kalman.velocity_m_s().x;
       }}};
  std::vector<TradeRow> rows;
  for (const auto& [name, update] : estimates) {
    if (progress.cancelled()) return tradesCancelled();
    std::vector<double> estimate_m_s;
    for (double sample_m : motion.samples_m) estimate_m_s.push_back(update(sample_m));
    TradeRow row;
    row.knob = "velocity_estimate";
    row.setting = name;
    row.error = 1e3 * rms(estimate_m_s, motion.true_m_s);
    row.error_unit = "mm/s";
    row.cost = 1e3 * lagOf(estimate_m_s, kPeriod_s, motion.fine_m_s, kPeriod_s / kFine, kMostLag_s);
    row.cost_unit = "ms of lag";
    row.reference =
        "RMS, true velocity of a simulated arm with an encoder of 0.055 mm, sampled at "
        "1 kHz: at rest, at 2 mm/s, and to and fro at up to 190 mm/s";
    rows.push_back(row);
  }
  return rows;
}

}  // namespace trephine
