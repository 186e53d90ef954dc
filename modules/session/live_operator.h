// The window's hands as an operator, over a script or alone.
#pragma once

#include <array>
#include <memory>

#include "base/rt/latest_value.h"
#include "haptics/haptic_loop.h"
#include "session/pointer_hand.h"
#include "session/pointer_path.h"

namespace trephine {

// What the window last asked of each hand.
struct LiveHands {
  struct Hand {
    bool live = false;  // false: the script, or rest, moves this hand
    Vec3 position_m{0.0};
    double stiffness_N_per_m = 0.0;
    double damping_Ns_per_m = 0.0;
    bool held = false;  // in a pause: rests at `held_m`, whoever moves it otherwise
    Vec3 held_m{0.0};
    bool pointed = false;     // live, and goes where the pointer is; `position_m` is not used
    Quat turned{1, 0, 0, 0};  // the tool, device frame; reached smoothly
  };
  std::array<Hand, kMaxArms> hands{};
  bool script_waits = false;  // its commands come later
};

class LiveOperator : public Operator {
 public:
  // `script` may be null. From where a pause held it a hand goes back to where it wants to be in
  // the 0.2 s in which the force comes back, or it would plunge into what does not yet push.
  LiveOperator(std::unique_ptr<Operator> script, rt::ParameterSet<LiveHands>& live, double period_s)
      : script_(std::move(script)),
        live_(live),
        period_s_(period_s),
        share_a_tick_(period_s / kComesBack_s) {}
  void setPoints(std::uint64_t tick, OperatorSetPoint* hands, std::size_t arm_count) override;
  bool command(std::uint64_t tick, Command& out) override;
  void moved(const TickRecord& record, const HapticParameters& parameters) override;

  // Of each arm's pointer: the window pushes what the tick plays.
  PointerPath& path(std::size_t arm) { return pointers_[arm].path; }
  // Before the first tick. Without, a session's time is its ticks.
  void useHostClock() { host_clock_ = true; }
  void setReach(std::size_t arm, const PointerHand::Reach& reach) { pointers_[arm].reach = reach; }

 private:
  static constexpr double kComesBack_s = 0.2;
  struct Release {
    Vec3 from_m{0.0};
    double share = 1.0;  // of the way back
  };
  std::unique_ptr<Operator> script_;
  rt::ParameterSet<LiveHands>& live_;
  double period_s_;
  double share_a_tick_;
  std::array<Release, kMaxArms> released_;

  struct Pointer {
    PointerPath path;
    PointerHand hand;
    PointerHand::Reach reach;
    WorkspaceMap map;  // of the last tick
    ArmRecord last;
    bool seen = false;  // there was one
    bool in_use = false;
    Quat turning{1, 0, 0, 0}, turned{1, 0, 0, 0};
  };
  bool point(std::uint64_t tick, std::size_t arm, bool held, OperatorSetPoint& hand);
  void turn(Pointer& pointer, const Quat& to) const;
  std::array<Pointer, kMaxArms> pointers_;
  bool host_clock_ = false;
};

}  // namespace trephine
