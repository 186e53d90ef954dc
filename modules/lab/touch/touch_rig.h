// Whole exercises in the laboratory: the real core, its arms held by hands that are told where to
// be. As `run` moves simulated arms (a force acts in the period that follows its sample), but for
// two things: where an arm is, is known beyond its encoder, and what is claimed of it may be
// untrue.
#pragma once

#include <vector>

#include "haptics/haptic_core.h"
#include "lab/common/held_arm.h"

namespace trephine {

// An arm as it is, held by a hand.
struct RigArm {
  double mass_kg = 0.045;
  double damping_Ns_per_m = 0.05;
  double encoder_m = 0.055e-3;
  Impedance hand{4.0, 600.0};
};

class TouchRig {
 public:
  // Of each arm of the core: what it is. `volume` is the rig's own; `labels`: for tissues of a
  // structure.
  TouchRig(const HapticParameters& parameters, Volume volume, const std::vector<RigArm>& arms,
           std::shared_ptr<const LabelMap> labels = nullptr);

  // Puts an arm and its hand there, at rest: before the first tick.
  void place(std::size_t arm, const Vec3& position_m);
  // Where the hand will be at the end of the next tick; it goes there at an even speed.
  void moveHand(std::size_t arm, const Vec3& rest_m) { arms_[arm].rest_m = rest_m; }
  void turnHand(std::size_t arm, const Quat& orientation) { arms_[arm].orientation = orientation; }
  void command(const Command& command) { commands_.push_back(command); }

  // One tick, and the arms move on for a period under what they are sent.
  const TickRecord& step();

  const TickRecord& record() const { return record_; }
  const Vec3& position_m(std::size_t arm) const { return arms_[arm].x; }  // true, device axes
  // The most that the arm had given out, net: counted on the samples, as in a session's report, and
  // on where the arm truly was.
  double energyOut_J(std::size_t arm) const { return arms_[arm].most_out_J; }
  double trueEnergyOut_J(std::size_t arm) const { return arms_[arm].most_truly_out_J; }
  // From now on: what was put in before hides nothing.
  void countTrueEnergyAnew(std::size_t arm) {
    arms_[arm].truly_out_J = arms_[arm].most_truly_out_J = 0.0;
  }
  std::uint64_t tick() const { return input_.tick; }
  const HapticCore& core() const { return core_; }
  const Grid& grid() const { return grid_; }

 private:
  struct Arm {
    HeldArm plant;
    double encoder_m;
    Vec3 x{0.0}, v{0.0}, rest_m{0.0}, last_rest_m{0.0};
    Quat orientation{1, 0, 0, 0};
    double most_out_J = 0.0, truly_out_J = 0.0, most_truly_out_J = 0.0;
  };
  Grid grid_;
  HapticCore core_;
  double period_s_;
  std::vector<Arm> arms_;
  std::vector<Command> commands_;
  TickInput input_;
  TickRecord record_;
};

}  // namespace trephine
