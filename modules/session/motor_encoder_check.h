// Whether an arm's encoders and motors agree, found without a person's judgement: how its samples
// scatter, and whether it goes where small known forces push it. Pure.
#pragma once

#include <array>

#include "base/math.h"
#include "session/hand_on_arm.h"

namespace trephine {

// It begins with a hand on the arm. 500 samples in which it goes slower than 50 mm/s, or any after
// 3 s, are looked at without a force. Then the arm is pushed for some hundredths of a second, and
// as long the other way: an arm of the stated mass is then at rest again, at most 3 mm further.
// Eight times along each axis, half of them each way, with rests of different lengths, so that
// neither a hand that drifts nor its tremor counts; 3 to 5 s together. What an arm does along all
// three axes is counted, so that what is wrong in a joint shows wherever that joint points. An
// encoder and a motor that are both reversed agree.
//
// No force where the samples scatter so that they say nothing, on an arm that states less than 2 g,
// and none any more once it goes 8 mm beside its line in a push, or faster than a hand, or is let
// go of. A push that a late tick has broken is done again, up to 30 times; then it ends as `late`.
// How fast it goes is taken from the time between two samples; what moved in a late tick does not
// count, since how long that was is not known.
class MotorEncoderCheck {
 public:
  // A finer step of an encoder than a hand can tell counts as this.
  static constexpr double kLeastStep_m = 5e-5;

  enum class Phase { off, waiting, still, pushing, done, lost, late, untouched };

  // `mass_kg` and `delay_s` as the arm states them; `most_N` is what it can be sent for good. A
  // hand is waited for `patience_s`; then it is `untouched`.
  void ask(double mass_kg, double delay_s, double most_N, double patience_s, double step_m);
  // The force [N], device frame, that answers this sample; `fresh`: it was not seen before; `late`:
  // it comes so late that the force before has acted for longer than a period.
  Vec3 tick(const HandSample& sample, bool fresh, bool late, double period_s);

  Phase phase() const { return phase_; }
  static bool runs(Phase phase) { return phase >= Phase::waiting && phase <= Phase::pushing; }
  // A standard deviation, from how far samples lie beside the line through their neighbours: the
  // 95 % of |x(n-1) - 2 x(n) + x(n+1)| / 4.8, of the worst axis; where single samples jump, the
  // farthest of them. What a steady hand does adds nothing. Once it pushes.
  double noise_m() const { return noise_m_; }
  bool pushed() const { return pushed_; }

  // R: how far the arm went along each axis of how far its stated mass goes freely, by least
  // squares, for a push along each; the unit matrix for a free arm, less in a firm hand.
  struct Response {
    double least = 0.0;    // eigenvalue of (R + R^T) / 2: below 0 it goes against a force
    Vec3 along{0.0};       // which is along this axis
    double weakest = 0.0;  // singular value of R: 0 where nothing answers
    double error = 0.0;    // standard error of an element, from how pushes differ
  };
  const Response& response() const { return response_; }  // once done and pushed()

 private:
  static constexpr int kStill = 500, kBefore = 10, kTimes = 8;  // samples; pushes along an axis
  static constexpr int kLongest = 120;                          // samples of one push

  Vec3 wait(const HandSample& sample, double period_s);
  void takeStill(const Vec3& at_m, bool fresh);
  void judgeStill();
  Vec3 push(const Vec3& at_m, bool late, double period_s);
  void judgePush(double period_s, int delay);
  void judge();
  double sign() const { return push_ % 4 == 0 || push_ % 4 == 3 ? 1.0 : -1.0; }

  Phase phase_ = Phase::off;
  double mass_kg_ = 0.0, delay_s_ = 0.0, most_N_ = 0.0, patience_s_ = 0.0, step_m_ = 0.0;
  double since_s_ = 0.0, noise_m_ = 0.0;
  Vec3 fast_m_s_{0.0}, slow_m_s_{0.0};  // over 10 and 50 ms
  bool pushed_ = false;
  HandOnArm hand_;
  Vec3 last_m_{0.0}, before_last_m_{0.0};
  int seen_ = 0, still_ = 0;
  double sampled_s_ = 0.0;  // since the last sample that was not seen before
  bool was_late_ = false;   // a tick since then
  int push_ = 0, tick_ = 0, half_ = 0, broken_ = 0;
  std::array<std::array<double, kStill>, 3> bends_m_{};
  std::array<Vec3, kLongest + kBefore> path_m_{};      // of this push
  std::array<std::array<Vec3, kTimes>, 3> columns_{};  // of R, by axis and push
  Response response_;
};

}  // namespace trephine
