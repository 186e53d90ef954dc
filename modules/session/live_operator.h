// The window's mouse as an operator, over a script or alone.
#pragma once

#include <array>
#include <memory>

#include "base/rt/latest_value.h"
#include "haptics/haptic_loop.h"

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
  };
  std::array<Hand, kMaxArms> hands{};
  bool script_waits = false;  // its commands come later
};

class LiveOperator : public Operator {
 public:
  // `script` may be null. From where a pause held it a hand goes back to where it wants to be in
  // the 0.2 s in which the force comes back, or it would plunge into what does not yet push.
  LiveOperator(std::unique_ptr<Operator> script, rt::ParameterSet<LiveHands>& live, double period_s)
      : script_(std::move(script)), live_(live), share_a_tick_(period_s / kComesBack_s) {}
  void setPoints(std::uint64_t tick, OperatorSetPoint* hands, std::size_t arm_count) override;
  bool command(std::uint64_t tick, Command& out) override;

 private:
  static constexpr double kComesBack_s = 0.2;
  struct Release {
    Vec3 from_m{0.0};
    double share = 1.0;  // of the way back
  };
  std::unique_ptr<Operator> script_;
  rt::ParameterSet<LiveHands>& live_;
  double share_a_tick_;
  std::array<Release, kMaxArms> released_;
};

}  // namespace trephine
