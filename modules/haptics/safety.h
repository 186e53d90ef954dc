// The last steps before the arm: clamp, ramps, lateness. Pure functions and one small state.
#pragma once

#include <cstdint>

#include "base/math.h"

namespace trephine {

// The force with at most `max_N`, its direction kept. Non-finite becomes zero.
Vec3 clampForce(const Vec3& force_N, double max_N);

// After a change (start, undo, tissue edit, controller, resume) the sent force may rise by at most
// kSlew until it has reached what is demanded, and for kCatchUp at least: a demand that is zero at
// rest, or dips for a tick, is reached at once and may be all of the force a tick later.
constexpr double kSlew_N_per_s = 50.0;  // 0.05 N per ms
constexpr double kCatchUp_s = 0.5;
constexpr double kCatchUpAtStart_s = 0.1;  // from rest
constexpr double kFade_s = 0.02;           // of the force of an arm that is clutched

// One tick towards `target_N`: the result has its direction, and is at most `step_N` longer than
// the part of `sent_before_N` along that direction. It may fall or change its direction at once.
Vec3 slewTowards(const Vec3& sent_before_N, const Vec3& target_N, double step_N);

// The share of the last force that a late tick still sends: 1 up to 5 ms, then in proportion down
// to 0 at 20 ms.
constexpr std::int64_t kHoldLate_ns = 5'000'000;
constexpr std::int64_t kStallLate_ns = 20'000'000;
double lateGain(std::int64_t late_ns);

// What lateness does to the force of all arms. A tick more than 20 ms late is a stall: the force is
// zero until 1 s has passed without a tick more than 5 ms late. After the third stall within 30 s,
// or one of over 2 s, it is zero until clear(). A function of recorded inputs alone, so that a
// replay does the same.
class LatenessRule {
 public:
  // Before the forces of a tick. `silenced`: the watchdog took the force away since the last tick,
  // which is a stall however late this tick came.
  void tick(std::int64_t late_ns, bool silenced, double period_s);
  // A person asks for the force: it need not wait.
  void clear() { *this = LatenessRule(); }

  bool away() const { return away_ || kept_; }
  bool kept() const { return kept_; }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.away_, self.kept_);
    archive(self.since_late_s_, self.last_stall_s_, self.stall_before_s_);
  }

 private:
  bool away_ = false, kept_ = false;
  double since_late_s_ = 0.0;    // s since a tick was more than 5 ms late
  double last_stall_s_ = 1e9;    // s since the last stall
  double stall_before_s_ = 1e9;  // s since the one before
};

// The last step before an arm: no force in a pause or a fault, less where a tick is late, a slow
// rise after a change.
class OutputLimiter {
 public:
  // The demanded force may jump: rise by kSlew until it is reached, and for kCatchUp_s at least.
  void change() { catch_up_s_ = kCatchUp_s; }
  // Voxels were put back: no force until the tool is out of tissue, then ramp in over 0.2 s.
  void restored() {
    rampIn();
    waiting_for_air_ = true;
  }
  void zero() {
    sent_N_ = Vec3(0.0);
    change();
  }
  // The force comes back over 0.2 s from the next tick that is open.
  void rampIn() {
    change();
    gain_ = 0.0;
  }

  // The arm is clutched: its force fades to nothing over 20 ms, from what was sent last, and stays
  // away until engage(), after which it rises as after any change.
  void release() {
    released_ = true;
    fading_N_ = sent_N_;
    fading_ = 1.0;
  }
  void engage() {
    released_ = false;
    change();
  }

  // The force to send this tick. `open` is false in a pause or a fault.
  Vec3 limit(const Vec3& clamped_N, bool touching, bool open, std::int64_t late_ns,
             double period_s);

  const Vec3& sent_N() const { return sent_N_; }
  // True after restored() while the tool has not been out of tissue: it must not cut either, or an
  // undo with the tool in place would cut at once what it put back.
  bool waitingForAir() const { return waiting_for_air_; }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.sent_N_, self.gain_, self.catch_up_s_);
    archive(self.waiting_for_air_, self.released_, self.fading_N_, self.fading_);
  }

 private:
  Vec3 sent_N_{0.0};
  double gain_ = 1.0;                      // of a ramp in, to 1 within 0.2 s
  double catch_up_s_ = kCatchUpAtStart_s;  // above 0: the rise is limited by kSlew
  bool waiting_for_air_ = false;
  bool released_ = false;
  Vec3 fading_N_{0.0};   // what was sent when it was released,
  double fading_ = 0.0;  // and the share of it that is left
};

}  // namespace trephine
