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
};

class LiveOperator : public Operator {
 public:
  // `script` may be null.
  LiveOperator(std::unique_ptr<Operator> script, rt::ParameterSet<LiveHands>& live)
      : script_(std::move(script)), live_(live) {}
  void setPoints(std::uint64_t tick, OperatorSetPoint* hands, std::size_t arm_count) override;
  bool command(std::uint64_t tick, Command& out) override;

 private:
  std::unique_ptr<Operator> script_;
  rt::ParameterSet<LiveHands>& live_;
};

}  // namespace trephine
