// One tick of touch, for all arms: a pure function of (state, device input, commands, parameters).
// No clock, no device, no thread; the loop, a replay and a test drive it alike and get the same
// bits. Nothing here allocates, locks, throws or does I/O after construction.
#pragma once

#include <optional>
#include <vector>

#include "haptics/contact.h"
#include "haptics/controllers.h"
#include "haptics/haptic_types.h"
#include "haptics/laws.h"
#include "haptics/safety.h"
#include "haptics/tool.h"
#include "haptics/workspace_map.h"
#include "volume/carve_journal.h"
#include "volume/grid.h"

namespace trephine {

struct ArmParameters {
  Tool tool;
  WorkspaceMap map;
  double max_force_N = 0.0;
  ArmDynamics dynamics;
};

struct HapticParameters {
  double period_s = 0.001;
  std::vector<ArmParameters> arms;  // at most kMaxArms
  std::vector<LawKind> laws;
  ControllerKind controller = ControllerKind::bounded;
  TissueTable tissues;
  double contact_hold_mm = 1.5;              // see findContact
  std::size_t journal_voxels = 8'000'000;    // 8 bytes each
  std::size_t journal_strokes = 4096;
  double stroke_gap_s = 0.3;                 // this long out of tissue ends a stroke
};

class HapticCore {
 public:
  // `writer` stays with the core: it is the one writer of the grid.
  HapticCore(const HapticParameters& parameters, Grid::Writer writer);

  // Applies `commands` (those that act on voxels only start here and go on in slices; at most one
  // of them a tick, or the second is lost), then moves every arm one tick. `record` is the outcome; carves() and events() list what happened.
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
  const Grid& grid() const { return writer_.grid(); }
  const HapticParameters& parameters() const { return parameters_; }
  bool paused() const { return paused_; }
  ControllerKind controller() const { return parameters_.controller; }
  std::uint64_t nonFinite() const { return nonfinite_; }
  bool journalFull() const { return journal_.full(); }

 private:
  struct Arm {
    std::vector<Law> laws;           // of the model: what the tissue demands
    std::vector<Law> rendered_laws;  // of what the controller lets the arm render
    std::vector<Controller> controllers;  // fresh ones, by kind: made before the first tick
    Controller controller;
    ForceGate gate;
    Contact contact;
    std::vector<Hit> hits;
    std::optional<Vec3> last_position_m;  // device
    Vec3 energy_out_J{0.0};
    std::uint32_t faults = 0;
    std::uint64_t air_ticks = 0;  // since the tool was last in tissue
  };

  void apply(const Command& command, std::uint64_t tick);
  void forgetForces(bool restored);
  void moveArm(std::size_t index, const TickInput& input, ArmRecord& out);
  void removeHits(std::size_t index, std::uint64_t tick, ArmRecord& out);
  void latch(std::size_t index, std::uint32_t fault, std::uint64_t tick);

  HapticParameters parameters_;
  Grid::Writer writer_;
  CarveJournal journal_;
  Mat4 patient_to_voxel_;
  std::vector<Arm> arms_;
  std::vector<CarveRecord> carves_;
  std::vector<Event> events_;
  std::uint64_t stroke_gap_ticks_;
  bool paused_ = false;
  bool reported_full_ = false;
  std::uint64_t nonfinite_ = 0;
};

}  // namespace trephine
