// Estimates of velocity from samples of a position, to be compared. One axis, metres and seconds.
#pragma once

#include <deque>
#include <vector>

namespace trephine {

class BackwardDifference {
 public:
  explicit BackwardDifference(double period_s) : period_s_(period_s) {}
  double update(double sample_m);

 private:
  double period_s_;
  double last_m_ = 0.0;
  bool started_ = false;
};

// The backward difference through a first-order low-pass: y += a (d - y), a = T / (T + 1 / 2 pi f).
class LowPassDifference {
 public:
  LowPassDifference(double period_s, double cutoff_hz);
  double update(double sample_m);

 private:
  BackwardDifference difference_;
  double share_;
  double filtered_m_s_ = 0.0;
};

// First-order adaptive window, end-fit (Janabi-Sharifi, Hayward and Chen 2000): the difference over
// the longest window, of up to `kMost` samples, in which every sample lies within `band_m` of the
// line through the window's ends.
class AdaptiveWindow {
 public:
  AdaptiveWindow(double period_s, double band_m) : period_s_(period_s), band_m_(band_m) {}
  double update(double sample_m);

  static constexpr std::size_t kMost = 64;

 private:
  double period_s_;
  double band_m_;
  std::deque<double> samples_m_;  // the newest first
};

// The delay at which the truth looks most like the estimate (least squares), 0 to `most_s` in whole
// steps of `fine_s` [s]. estimate[n] belongs to the time n * period_s, truth[i] to i * fine_s.
double lagOf(const std::vector<double>& estimate, double period_s, const std::vector<double>& truth,
             double fine_s, double most_s);

}  // namespace trephine
