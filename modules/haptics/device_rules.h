// What an arm says of itself and what that does to its force: errors that pass, and warm motors.
// Functions of recorded inputs alone, so that a replay does the same.
#pragma once

#include <optional>

#include "haptics/arm_dynamics.h"

namespace trephine {

// An error that passes (TREPHINE_ARM_ERROR) takes an arm's force away while it is said and for 1 s
// more. The third that begins within 10 s takes it away until clear().
class ErrorRule {
 public:
  // Before the force of a tick.
  void tick(bool error, double period_s);
  // A person asks for the force: it need not wait.
  void clear() { *this = ErrorRule(); }

  bool away() const { return away_ || kept_; }
  bool kept() const { return kept_; }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.said_, self.away_, self.kept_);
    archive(self.since_said_s_, self.last_begin_s_, self.begin_before_s_);
  }

 private:
  bool said_ = false, away_ = false, kept_ = false;
  double since_said_s_ = 0.0;
  double last_begin_s_ = 1e9;    // s since one began
  double begin_before_s_ = 1e9;  // s since the one before
};

// The most that an arm is sent for now. Motors that say they are warm (TREPHINE_ARM_WARM): the
// limit falls to half over 2 s, and returns as slowly. Motors that do not look after themselves are
// counted as warm as the square of the force makes them, with their time constant tau,
//   dh/dt = ((F / F_c)^2 - h) / tau,
// where h = 1 is what the continuous force F_c holds them at: from h = 0.8 to 1 the limit falls
// from the peak to F_c.
class WarmthRule {
 public:
  // Before the force of a tick: the limit [N]. `sent_N`: the force held since the last one.
  double limit_N(double most_N, bool warm, double sent_N, const ArmDynamics& arm, double period_s);
  // The last limit was below the most.
  bool limits() const { return limits_; }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.share_, self.warmth_);
  }

 private:
  double share_ = 1.0;   // of the most, by the motors' own word
  double warmth_ = 0.0;  // h
  bool limits_ = false;  // in this tick
};

// Whether an arm has been silent: a pose that has been the same sample for 15 ms is no pose of now,
// whatever its plugin says. With the patience that the clock has for a sample, within 20 ms of the
// last. Ticks that make up for late ones say nothing: a real arm's silence lasts by the clock too.
class SilenceRule {
 public:
  // `now_ns` of that clock; none of a simulated arm, whose time is the ticks'.
  bool tick(std::uint64_t sequence, double period_s, std::optional<std::int64_t> now_ns = {});

 private:
  std::uint64_t last_ = 0, ticks_ = 0;
  std::int64_t last_ns_ = 0;
};

// Whether a hand is known to hold an arm: it has a button down, or has been moved 5 mm or turned 5
// degrees from where it was at first, since it is here.
class HandRule {
 public:
  // True from then on, until the arm is lost.
  bool tick(const Pose& pose_m, bool button, bool lost);

 private:
  bool held_ = false;
  std::optional<Pose> first_;
};

}  // namespace trephine
