// A hand that swings an emulated WoodenHaptics arm, under the force of the board's motors.
#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "wooden_arm.h"
#include "wooden_firmware.h"

namespace trephine::test {

// A point mass in a hand that leads it to and fro along the arm's x.
class WoodenHand {
 public:
  // What the board's motors give where the arm is now [N].
  woodenhaptics::Vector force_N(const WoodenFirmware& board) const {
    return forceAt(board.milliamps(), angles_);
  }
  // What these currents give at an arm that stands so.
  static woodenhaptics::Vector forceAt(const std::array<std::int16_t, 3>& milliamps,
                                       const woodenhaptics::Vector& angles) {
    woodenhaptics::Vector amps{};
    for (std::size_t i = 0; i < 3; ++i) amps[i] = 1e-3 * milliamps[i];
    return test::forceOf(angles, torquesOf(amps));
  }
  const woodenhaptics::Vector& angles() const { return angles_; }
  // A millisecond further under this force, and the board counts where the arm is.
  void step(WoodenFirmware& board, const woodenhaptics::Vector& force_N, double time_s) {
    constexpr double kMass_kg = 0.15, kHand_N_per_m = 400.0, kHand_Ns_per_m = 6.0, kT_s = 1e-3;
    const woodenhaptics::Vector hand{0.025 * std::sin(2.0 * std::numbers::pi * 0.5 * time_s), 0.0,
                                     0.0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double pull = force_N[axis] + kHand_N_per_m * (hand[axis] - at_m_[axis]) -
                          kHand_Ns_per_m * speed_m_s_[axis];
      speed_m_s_[axis] += kT_s * pull / kMass_kg;
      at_m_[axis] += kT_s * speed_m_s_[axis];
    }
    if (!anglesAt(at_m_, angles_)) return;
    const woodenhaptics::Vector counts = countsAt(angles_);
    std::array<std::int16_t, 3> seen{};
    for (std::size_t i = 0; i < 3; ++i) {
      seen[i] = std::int16_t(std::lround(counts[i] + scatter_ * normal_(random_)));
    }
    if (reversed_) seen[0] = std::int16_t(-seen[0]);
    board.setCounts(seen);
  }
  // What may be wrong with the arm: a standard deviation in counts; the first encoder's two wires
  // the wrong way round.
  void setScatter(double counts) { scatter_ = counts; }
  void setReversed() { reversed_ = true; }

 private:
  woodenhaptics::Vector at_m_{}, speed_m_s_{}, angles_{};
  double scatter_ = 0.0;
  bool reversed_ = false;
  std::mt19937 random_{11};
  std::normal_distribution<double> normal_;
};

}  // namespace trephine::test
