// The path of a pointer on a screen, played to the tick. The window sends samples with their times;
// the tick plays them a constant 25 ms later, in straight lines between them, so that a path gives
// the same motion however often a second it was sampled.
#pragma once

#include <cstdint>
#include <optional>

#include "base/math.h"
#include "base/rt/event_ring.h"

namespace trephine {

// Where a pointer was: the ray from the eye through it.
struct PointerSample {
  std::int64_t time_ns = 0;          // std::chrono::steady_clock; freewheeling, of the session
  Vec3 origin_mm{0.0};               // patient
  Vec3 direction{0.0, 0.0, -1.0};    // patient, away from the eye; any length
  std::optional<double> depth_mm{};  // from `origin_mm` to the tissue seen there; none: over air
};

// A sample, and what the hand does there.
struct PointerInput {
  PointerSample at;
  double push_N = 0.0;    // of the hand on the arm, along the tool; 0: hovers
  bool put_down = false;  // not in use from here on
};

class PointerPath {
 public:
  // Longer than the 17 ms between two events of a slow mouse, so that the next is there in time.
  // A pointer that has sent nothing for so long has rested.
  static constexpr std::int64_t kDelay_ns = 25'000'000;
  // No faster than this at the tool [mm/s]; what a pointer is ahead of it is caught up with.
  static constexpr double kFastest_mm_s = 250.0;

  // One thread, in order of time. False where more than 2048 wait.
  bool push(const PointerInput& input) { return waiting_.push(input); }

  // Haptic thread. A period later, at `now_ns`; lengths are measured at this depth along the ray.
  // Samples that came late keep their line, and what is behind is caught up with.
  void advance(std::int64_t now_ns, std::int64_t period_ns, double depth_mm);
  // Null before the first sample was due.
  const PointerInput* at() const { return started_ ? &at_ : nullptr; }
  void forget();  // and drops what waits

 private:
  bool take();
  void rest(std::int64_t until_ns);
  void move(double share);

  rt::EventRing<PointerInput> waiting_{2048};
  std::optional<PointerInput> next_;
  bool started_ = false;
  PointerInput at_;                // its time is how far it has been played
  std::int64_t last_time_ns_ = 0;  // of the last sample that was passed
};

}  // namespace trephine
