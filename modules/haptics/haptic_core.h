// One tick of touch, for all arms: a pure function of (state, device input, commands, parameters).
// No clock, no device, no thread; the loop, a replay and a test drive it alike and get the same
// bits. After construction a tick allocates nothing, locks nothing, throws nothing and does no I/O.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "haptics/contact.h"
#include "haptics/controllers.h"
#include "haptics/device_rules.h"
#include "haptics/hand_work.h"
#include "haptics/haptic_parameters.h"
#include "haptics/haptic_types.h"
#include "haptics/laws.h"
#include "haptics/proxy.h"
#include "haptics/removal.h"
#include "haptics/safety.h"
#include "haptics/soft_hold.h"
#include "haptics/tissue_field.h"
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

  // Net work of the sent force on the arm in the ticks before this core's first, by axis. Called
  // before that tick, where a session goes on that another core began.
  void setEnergyOut(std::size_t arm, const Vec3& energy_out_J) {
    arms_[arm].energy_out_J = energy_out_J;
  }

  // False while an undo, redo or reset is still going on: the caller keeps all commands for a later
  // tick. One that acts on voxels would be lost now.
  bool acceptsCommands() const { return !journal_.busy(); }

  const std::vector<CarveRecord>& carves() const { return carves_; }  // of the last tick
  const std::vector<Event>& events() const { return events_; }        // of the last tick

  const CarveJournal& journal() const { return journal_; }
  CarveJournal& journal() { return journal_; }  // for its file
  const Grid& grid() const { return writer_.grid(); }
  const HapticParameters& parameters() const { return parameters_; }

  // ---- Its state as a value, between two ticks: all that the ticks before left behind and one to
  // come reads. A core that has loaded it goes on, given the same inputs, bit for bit as the saved
  // one does (core_state_test). For whoever joins late, and for going back and forth in time.
  //
  // Not in it: the parameters that no command changes; the volume, and the log of what was removed
  // from it; what the loop keeps (devices, clock, watchdog, commands that wait), which comes in as
  // input; carves() and events() of the last tick; and what follows from the rest and is made anew:
  // look-up tables of the tissues, and what removal and the proxy's search lay out for a pass.
  std::vector<std::byte> save() const;
  // Into a core made of the same parameters, on a grid with the same voxels, whose journal has the
  // same log (journal().log(): append() its entries in order). Errors: BAD_STATE, also where the
  // parameters are others or the journal is at another place; the core is then as it was.
  Status load(std::span<const std::byte> bytes);

  bool paused() const { return paused_; }
  ControllerKind controller() const { return parameters_.controller; }
  std::uint64_t nonFinite() const { return nonfinite_; }
  std::size_t unknownBricks() const { return tissue_.unknownBricks(); }
  bool journalFull() const { return journal_.full(); }
  // Which of its tools an arm has, and which it is to have: another one while that waits.
  std::size_t toolInHand(std::size_t arm) const { return arms_[arm].in_hand; }
  std::size_t toolWanted(std::size_t arm) const { return arms_[arm].wanted; }

 private:
  // One of an arm's tools, and what is kept for it from tick to tick while it is in hand.
  struct ArmTool {
    ArmTool(const Tool& tool, const HapticParameters& all, const GridGeometry& geometry);

    Tool made;
    std::vector<Law> laws;
    ToolContact contact;
    std::optional<Proxy> proxy;  // where a law stops it at solid tissue; else it is at its arm
    std::optional<SoftHold> soft;  // where a law holds it in soft tissue
    Removal removal;
    std::vector<TouchPoint> points;
    double rubs_N = 0.0;  // dry friction of the solid tissue that it touched in the last tick
    Cutting cutting = Cutting::by_hand;

    template <class Self, class Archive>
    static void visitState(Self& self, Archive& archive) {
      archive(self.laws, self.contact, self.removal, self.rubs_N);
      if (self.proxy) archive(*self.proxy);
      if (self.soft) archive(*self.soft);
    }
  };
  struct Arm {
    Arm(const ArmParameters& parameters, const HapticParameters& all, const GridGeometry& geometry);

    ArmTool& tool() { return tools[in_hand]; }
    const ArmTool& tool() const { return tools[in_hand]; }

    std::vector<ArmTool> tools;  // all are made before the first tick
    std::size_t in_hand = 0, wanted = 0;
    std::vector<Controller> controllers;  // fresh ones, by kind: made before the first tick
    Controller controller;
    OutputLimiter limiter;
    ErrorRule errors;
    WarmthRule warmth;
    std::vector<RemovedVoxel> removed;                   // of this tick
    VoxelBounds removed_box;                             // that holds them
    // Their linear indices, sorted; filled only where another arm may have removed one of them too.
    std::vector<std::uint32_t> removed_indices;
    std::optional<Pose> last_pose;  // device
    Pose tool_mm;                   // where the tool is, and stays while its arm is clutched
    bool clutched = false;
    // A new map that this command asks for, made with the arm's next sample.
    CommandKind remap = CommandKind::none;
    std::optional<Quat> turn_to;  // of the map
    bool as_exercise = false;        // the map, wherever the arm is
    WorkspaceMap exercise_map;
    HandWork work;
    double cut_J = 0.0;         // work that parted soft tissue and of motors, by the law of cutting
    Vec3 last_model_N{0.0};     // demanded in the tick before, patient axes
    Vec3 last_elastic_Nm{0.0};  // of the rendered springs in the tick before, patient axes
    bool cuts = false;           // may remove in this tick
    bool placed = false;         // the proxy was placed at the arm's first pose
    bool waiting = false;        // without force, until it is out of tissue
    bool not_as_stated = false;  // mass or delay proved to be another, in any tick so far
    double hooked_s = 0.0;       // for so long the arm has been in air and far from the tool
    double let_go_share = 0.0;   // of the force of a hooked tool that has faded; 1: all of it
    Vec3 energy_out_J{0.0};
    std::uint32_t faults = 0;
    std::uint64_t air_ticks = 0;  // since the tool was last in tissue

    // The controller is of the kind that was saved.
    template <class Self, class Archive>
    static void visitState(Self& self, Archive& archive) {
      archive(self.tools);
      archive.within(self.in_hand, 0, std::int64_t(self.tools.size()));
      archive.within(self.wanted, 0, std::int64_t(self.tools.size()));
      archive(self.controller, self.limiter, self.errors, self.warmth);
      archive(self.last_pose, self.tool_mm);
      archive(self.clutched, self.remap, self.turn_to, self.as_exercise);
      archive(self.work, self.cut_J, self.last_model_N, self.last_elastic_Nm);
      archive(self.placed, self.waiting, self.not_as_stated, self.hooked_s, self.let_go_share);
      archive(self.energy_out_J, self.faults, self.air_ticks);
    }
  };
  // How an arm moved since the last tick, patient axes, and where its tool is: at its proxy.
  struct Motion {
    Pose arm_mm, pose_mm;
    Vec3 velocity_m_s{0.0};
    Vec3 angular_velocity_rad_s{0.0};
  };

  void apply(const Command& command, std::uint64_t tick);
  void followLateness(const TickInput& input);
  void forgetLaws(Arm& arm);
  void forgetForces(bool restored);
  void forgetForce(Arm& arm, bool restored);
  void releaseArm(const Command& command);
  void finishRestore();
  void useTissues();
  void changeTissues(const TissueTable& tissues);

  // The tick of an arm, and its steps in their order (haptic_core_step.cpp).
  struct ArmTick;
  void moveArm(std::size_t index, const TickInput& input, ArmRecord& out);
  bool sample(ArmTick& now);
  void followDevice(ArmTick& now);
  void moveProxy(ArmTick& now);
  void touch(ArmTick& now);
  void demand(ArmTick& now);
  void render(ArmTick& now);
  void bound(ArmTick& now);
  void checkFinite(ArmTick& now);
  void send(ArmTick& now);
  void giveWork(ArmTick& now);
  void record(ArmTick& now);
  static void recordWork(const Arm& arm, ArmRecord& out);

  // Parts of sample (haptic_core_clutch.cpp).
  void engageArm(ArmTick& now, const Pose& device_m);
  void recentreArm(ArmTick& now, const Pose& device_m);

  // Another tool in hand (haptic_core_tool.cpp).
  void changeTool(ArmTick& now);
  bool mayChangeTool(ArmTick& now);
  void takeTool(std::size_t index, std::uint64_t tick);

  // Parts of moveProxy, touch and giveWork (haptic_core_touch.cpp).
  void startAtArm(ArmTick& now);
  bool startsInTissue(ArmTool& tool, const Pose& arm_mm);
  void followArm(ArmTick& now);
  void followBy(ArmTick& now, const Pose& wanted_mm, bool still);
  void placeTool(ArmTool& tool, const Pose& arm_mm) const;
  void letGoOfHook(ArmTick& now);
  bool wouldTouch(const ArmTool& tool, const Pose& pose_mm) const;
  void touchPoints(ArmTool& tool, const Motion& motion) const;
  double rubbing_N(const ArmTool& tool) const;
  bool paysByCutting() const { return names(parameters_.laws, LawKind::cutting); }
  bool atWork(const Arm& arm) const;
  static bool motorIsOff(const Arm& arm, std::uint32_t buttons);
  static bool motorRuns(const Arm& arm, std::uint32_t buttons) {
    return arm.tool().cutting == Cutting::driven && !motorIsOff(arm, buttons);
  }

  // Removal, once all arms have moved (haptic_core_removal.cpp).
  void removeVoxels(std::uint64_t tick, TickRecord& record);
  void sweepTools(const TickRecord& record);
  void sweepTool(Arm& arm, const ArmRecord& moved);
  void indexShared();
  bool alsoRemoves(const Arm& arm, const Index3& voxel) const;
  std::array<std::size_t, kMaxArms> newestStrokeFirst(const CarveJournal::Credits& before,
                                                      std::uint64_t tick);
  void eraseOf(std::size_t place, const std::array<std::size_t, kMaxArms>& order,
               std::uint64_t tick, TickRecord& record);
  void returnShares(const RemovedVoxel& removed, std::size_t owner, std::uint32_t sharers);
  bool erase(std::size_t index, const RemovedVoxel& removed, std::size_t voxel,
             std::uint32_t sharers, std::uint64_t tick);
  void tellProxies();
  void endStrokes();
  CarveJournal::Credits credits() const;
  void latch(std::size_t index, std::uint32_t fault, std::uint64_t tick);

  // As a value (haptic_core_state.cpp).
  template <class Archive>
  void visitParameters(Archive& archive) const;
  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive);
  Status read(std::span<const std::byte> state);

  HapticParameters parameters_;
  Grid::Writer writer_;
  CarveJournal journal_;
  TissueField tissue_;
  LawTissues law_tissues_;
  bool tissues_finite_ = true;
  bool any_cuttable_ = false;
  LatenessRule lateness_;
  std::vector<Arm> arms_;
  std::vector<CarveRecord> carves_;
  std::vector<std::uint32_t> went_;     // the solid ones among them
  std::vector<std::uint32_t> changed_;  // voxels of this tick's slice of an undo, redo or rewind
  std::vector<Event> events_;
  std::uint64_t stroke_gap_ticks_;
  std::uint64_t second_ticks_;
  std::uint64_t ticks_ = 0;  // outside pauses, in which the exercise's seconds do not count on
  bool may_remove_ = false;  // in this tick
  bool paused_ = false;
  bool reported_full_ = false;
  std::uint64_t nonfinite_ = 0;
};

}  // namespace trephine
