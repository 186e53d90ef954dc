// One tick of touch, for all arms: a pure function of (state, device input, commands, parameters).
// No clock, no device, no thread; the loop, a replay and a test drive it alike and get the same
// bits. Nothing here allocates, locks, throws or does I/O after construction.
#pragma once

#include <optional>
#include <vector>

#include "haptics/contact.h"
#include "haptics/controllers.h"
#include "haptics/hand_work.h"
#include "haptics/haptic_parameters.h"
#include "haptics/haptic_types.h"
#include "haptics/laws.h"
#include "haptics/proxy.h"
#include "haptics/removal.h"
#include "haptics/safety.h"
#include "haptics/stiffness_ball.h"
#include "haptics/tool.h"
#include "haptics/workspace_map.h"
#include "volume/carve_journal.h"
#include "volume/grid.h"

namespace trephine {

class HapticCore {
 public:
  // `writer` stays with the core: it is the one writer of the grid.
  HapticCore(const HapticParameters& parameters, Grid::Writer writer);

  // Asked before each tick and given to it: JournalState bits.
  std::uint32_t journalState();

  // Goes on with an undo, redo or rewind; applies `commands` (those that act on voxels only start
  // here and go on in slices from the next tick; at most one of them a tick, or the second is
  // lost); moves every arm one tick, all on the tissue as it is now; then removes what they cut, so
  // that the order of the arms changes nothing. `record` is the outcome; carves() and events() list
  // what happened.
  void tick(const TickInput& input, const Command* commands, std::size_t command_count,
            TickRecord& record);

  // Continues an arm's account of a longer session; before the first tick.
  void setEnergyOut(std::size_t arm, const Vec3& energy_out_J) {
    arms_[arm].energy_out_J = energy_out_J;
  }

  // False while an undo, redo or reset is still going on: commands then wait for a later tick.
  bool acceptsCommands() const { return !journal_.busy(); }

  const std::vector<CarveRecord>& carves() const { return carves_; }  // of the last tick
  const std::vector<Event>& events() const { return events_; }        // of the last tick

  const CarveJournal& journal() const { return journal_; }
  CarveJournal& journal() { return journal_; }  // for the one that spills it
  const Grid& grid() const { return writer_.grid(); }
  const HapticParameters& parameters() const { return parameters_; }
  bool paused() const { return paused_; }
  ControllerKind controller() const { return parameters_.controller; }
  std::uint64_t nonFinite() const { return nonfinite_; }
  std::size_t unknownBricks() const { return bricks_->unknown(); }  // of which air is not known
  bool journalFull() const { return journal_.full(); }

 private:
  struct Arm {
    Arm(const ArmParameters& parameters, const HapticParameters& all, const GridGeometry& geometry);

    std::vector<Law> laws;           // of the model: what the tissue demands
    std::vector<Law> rendered_laws;  // of what the controller lets the arm render
    std::vector<Controller> controllers;  // fresh ones, by kind: made before the first tick
    Controller controller;
    ForceGate gate;
    ToolContact contact;
    std::optional<StiffnessBall> ball;  // both only with the elastic law: without it the tool is
    std::optional<Proxy> proxy;         // where the arm is
    Removal removal;
    std::vector<TouchPoint> points;
    std::vector<Bite> bites;  // of this tick
    Index3 bites_low{0, 0, 0}, bites_high{0, 0, 0};  // their bounds
    std::vector<std::uint32_t> taken;                // their voxels in order, near another arm's
    std::optional<Pose> last_pose;  // device
    HandWork work;
    Vec3 last_model_N{0.0};  // patient axes
    Vec3 last_elastic_Nm{0.0};  // as rendered, patient axes
    Cutting cutting = Cutting::by_hand;
    bool cuts = false;     // may remove in this tick
    bool placed = false;   // its first pose came
    bool waiting = false;  // without force, until it is out of tissue
    bool not_as_stated = false;  // mass or delay proved to be another, ever
    double free_s = 0.0;   // for so long the arm's own pose has been free, and the tool far from it
    double letting_go = 0.0;  // above 0: what of the force has faded; 1: all
    Vec3 energy_out_J{0.0};
    std::uint32_t faults = 0;
    std::uint64_t air_ticks = 0;  // since the tool was last in tissue
  };
  // How an arm moved since the last tick, patient axes; the tool is at its proxy.
  struct Motion {
    Pose arm_mm, pose_mm;
    Vec3 velocity_m_s{0.0};
    Vec3 turning_rad_s{0.0};
  };

  void apply(const Command& command, std::uint64_t tick);
  void followLateness(const TickInput& input);
  void forgetLaws();
  void forgetForces(bool restored);
  void finishRestore();
  void moveArm(std::size_t index, const TickInput& input, ArmRecord& out);
  void moveTool(std::size_t index, bool may_cut, std::uint64_t tick, Motion& motion);
  void letGoOfHook(std::size_t index, std::uint64_t tick, const Motion& motion);
  bool wouldTouch(const Arm& arm, const Pose& pose_mm) const;
  LawInput touch(Arm& arm, const Tool& tool, const Motion& motion);
  bool atWork(const Arm& arm, const Tool& tool) const;
  void removeBites(std::uint64_t tick, TickRecord& record);
  void bite(Arm& arm, const ArmRecord& moved);
  bool takes(const Arm& arm, const Index3& voxel) const;
  void sortBites();
  std::array<std::size_t, kMaxArms> newestStrokeFirst(const CarveJournal::Credits& before,
                                                      std::uint64_t tick);
  bool erase(std::size_t index, const Bite& bite, std::size_t voxel, std::uint32_t sharers,
             std::uint64_t tick);
  void useTissues(const TissueTable& before);
  CarveJournal::Credits credits() const;
  void latch(std::size_t index, std::uint32_t fault, std::uint64_t tick);

  HapticParameters parameters_;
  Grid::Writer writer_;
  CarveJournal journal_;
  TissueLookup lookup_;
  std::optional<TissueBricks> bricks_;
  StiffnessByLabel stiffness_;  // only with the elastic law
  bool elastic_ = false;
  bool tissues_finite_ = true;
  bool any_cuttable_ = false;
  bool soft_push_ = false;  // some soft tissue pushes by the elastic law
  LatenessRule lateness_;
  std::vector<Arm> arms_;
  std::vector<CarveRecord> carves_;
  std::vector<std::uint32_t> put_back_;  // voxels of this tick's slice of an undo, redo or rewind
  std::vector<Event> events_;
  std::uint64_t stroke_gap_ticks_;
  std::uint64_t second_ticks_;
  std::uint64_t ticks_ = 0;  // outside pauses: the seconds of the exercise stand still in one
  bool may_remove_ = false;  // in this tick
  bool paused_ = false;
  bool reported_full_ = false;
  std::uint64_t nonfinite_ = 0;
};

}  // namespace trephine
