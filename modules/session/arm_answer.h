// Whether an arm's encoders and motors agree, found without a person's judgement: how its samples
// scatter, and whether it goes where a small known force pushes it. Pure.
#pragma once

#include <array>

#include "base/math.h"
#include "session/force_test.h"

namespace trephine {

// It begins with a hand on the arm, as ForceTest does: a button, or the arm moved by 5 mm. Half a
// second is looked at without a force; then the arm is pushed for some hundredths of a second, and
// as long the other way, which leaves it at rest again, at most 3 mm further. Four times along each
// axis, twice each way, so that a hand that drifts cancels; 2 s together, shorter than a hand
// answers. No force where the samples scatter so much that they say nothing.
class ArmAnswer {
 public:
  enum class Phase { off, waiting, still, pushing, done, lost, untouched };

  // `mass_kg` and `delay_s` as the arm states them; `most_N` is what it can be sent for good. A
  // hand is waited for `patience_s`; then it is `untouched`.
  void ask(double mass_kg, double delay_s, double most_N, double patience_s, double step_m);
  // The force [N], device frame, that answers this sample; `fresh`: it was not seen before.
  Vec3 tick(const ForceTest::Sample& sample, bool fresh, double period_s);

  Phase phase() const { return phase_; }
  static bool runs(Phase phase) { return phase >= Phase::waiting && phase <= Phase::pushing; }
  // A standard deviation, from how far samples lie beside the line through their neighbours: the
  // 95 % of |x(n-1) - 2 x(n) + x(n+1)| / 4.8, of the worst axis. What a steady hand does adds
  // nothing. Once it pushes.
  double noise_m() const { return noise_m_; }
  // How far it went of how far the stated mass goes freely, by least squares, along x, y and z: 1,
  // less in a firm hand, 0 where nothing pushes, below 0 where it goes the other way. Once done and
  // pushed().
  const std::array<double, 3>& shares() const { return shares_; }
  bool pushed() const { return pushed_; }

 private:
  static constexpr int kStill = 500, kBefore = 10, kPushes = 12;  // samples; 3 axes, 4 times
  static constexpr int kLongest = 120;                            // samples of one push

  void takeStill(const Vec3& at_m, bool fresh);
  Vec3 push(const Vec3& at_m, double period_s);
  void judge(double period_s, int late);
  double sign() const { return push_ % 4 == 0 || push_ % 4 == 3 ? 1.0 : -1.0; }

  Phase phase_ = Phase::off;
  double mass_kg_ = 0.0, delay_s_ = 0.0, most_N_ = 0.0, patience_s_ = 0.0, step_m_ = 0.0;
  double since_s_ = 0.0, noise_m_ = 0.0;
  bool placed_ = false, by_button_ = false, pushed_ = false;
  Vec3 asked_at_m_{0.0}, last_m_{0.0}, before_last_m_{0.0};
  int still_ = 0, push_ = 0, tick_ = 0, half_ = 0;
  std::array<std::array<double, kStill>, 3> bends_m_{};
  std::array<double, kLongest + kBefore> along_m_{};  // of this push
  std::array<double, 3> ya_{}, aa_{}, shares_{};
};

}  // namespace trephine
