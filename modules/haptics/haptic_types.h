// What goes into a tick and what comes out of it: plain data, recorded as it is.
#pragma once

#include <array>
#include <cstdint>

#include "base/math.h"
#include "haptics/controllers.h"
#include "tissue/tissue_set.h"
#include "volume/carve_journal.h"

namespace trephine {

// What a device said of one arm.
struct ArmSample {
  Vec3 position_m{0.0};         // device frame
  Quat orientation{1, 0, 0, 0};
  std::uint32_t buttons = 0;
  std::uint32_t flags = 0;      // TREPHINE_ARM_*
};

// What the journal allows in a tick; it depends on another thread, so it is an input and recorded.
enum JournalState : std::uint32_t {
  kJournalRoom = 1u << 0,   // removal may go on
  kJournalReady = 1u << 1,  // the next slice of an undo, redo or rewind is in memory
};

struct TickInput {
  std::uint64_t tick = 0;
  std::int64_t late_ns = 0;
  std::uint32_t journal = kJournalRoom | kJournalReady;
  bool silenced = false;  // the watchdog took the force away since the last tick
  std::array<ArmSample, kMaxArms> arms{};
};

// Live and scripted input to the writer of the voxels, applied at the start of a tick.
enum class CommandKind : std::int32_t {
  none,
  undo,
  redo,
  reset,
  pause,
  resume,
  clear_faults,
  controller,
  tissues,
  rewind,
  // Of one arm. Clutched, it moves without force, and its tool stays where it is. Off again, its
  // map is set so that the tool stays there; re-centred, so that the arm, where it is, is where the
  // exercise puts its device's origin, or as the exercise has it.
  clutch_on,
  clutch_off,
  recentre,
  // Of one arm: it takes another of its tools, once neither that nor the one in hand would touch
  // tissue and the arm has no force.
  tool,
  // Of one arm, by a script: its device is as if it were gone, and there again. The loop does it;
  // the core takes no notice.
  device_lost,
  device_back
};

struct Command {
  CommandKind kind = CommandKind::none;
  // controller: a ControllerKind; rewind: to this second of the session; clutch_off: 1, the map
  // turns to `rotation`, device axes to patient axes; 0, it keeps its own; recentre: 1, the map is
  // the exercise's, of a hand that goes back by itself; tool: which of the arm's (ArmParameters).
  std::int32_t value = 0;
  // tissues: the new table, which stays as it is and where it is as long as the command, or an
  // event with it, is looked at.
  const TissueTable* tissues = nullptr;
  std::int32_t arm = -1;   // clutch_on and what comes after it
  Quat rotation{1, 0, 0, 0};
};

// Zero force and no removal while any stands. Each but kPassingFaults stays until clear_faults.
enum Fault : std::uint32_t {
  kFaultNonFinite = 1u << 0,    // velocity or force was not a number, or the pose none of an arm
  kFaultLate = 1u << 1,         // a tick came more than 20 ms late; goes by itself (LatenessRule)
  kFaultDeviceLost = 1u << 2,   // the plugin reports the arm gone
  kFaultStalled = 1u << 3,      // that happened too often or for too long
  kFaultStuck = 1u << 4,        // a call of the device did not return: its arms were left behind
  kFaultDevice = 1u << 5,       // the arm reports an error; goes by itself (ErrorRule)
  kFaultDeviceOften = 1u << 6,  // the third of these within 10 s
};
constexpr std::uint32_t kPassingFaults = kFaultLate | kFaultDevice;

// What keeps a tool from its arm, or from force.
enum ToolState : std::uint32_t {
  kToolWaits =
      1u << 0,          // it started in tissue: no force and no cutting until it has been out of it
  kToolHeld = 1u << 1,  // solid tissue keeps it from its arm
  kToolLetGo = 1u << 2,     // was hooked; the force fades, then the tool goes to its arm
  kToolClutched = 1u << 3,  // its arm moves without it
  kToolToCome = 1u << 4,    // another tool is wanted, and comes once this one is out of tissue
  kToolArmWarm = 1u << 5,   // its arm's motors are warm: they give less than they can
  kToolNoHand = 1u << 6,    // nobody is known to hold its arm: no force and no cutting
  kToolOff = 1u << 7,       // its motor is off: the pedal is up
};

// Bits of an arm's buttons, in samples and records.
enum ArmButton : std::uint32_t {
  kArmButtons = 0xFFu,  // its own, as the plugin numbers them
  // The pedal's, the same for all arms, and that there is one: a tool with a motor runs while the
  // middle one is down. One that is lost is up, until somebody goes on without it: clear_faults,
  // where no arm has one.
  kPedalLeft = 1u << 8,
  kPedalMiddle = 1u << 9,
  kPedalRight = 1u << 10,
  kPedalLost = 1u << 14,
  kPedalThere = 1u << 15
};

// What one arm did in one tick. Forces at the device, in device axes, on the arm.
struct ArmRecord {
  Vec3 device_position_m{0.0};
  Quat device_orientation{1, 0, 0, 0};
  Vec3 patient_position_mm{0.0};  // the tool's tip
  Quat patient_orientation{1, 0, 0, 0};
  // Where the tool is, and is drawn: it stays out of solid tissue that is uncut.
  Vec3 proxy_position_mm{0.0};
  Quat proxy_orientation{1, 0, 0, 0};
  Vec3 velocity_m_s{0.0};  // of the arm, patient axes, backward difference
  Vec3 demanded_N{0.0};    // from the laws
  Vec3 demanded_torque_Nm{0.0};  // about the handle, for arms that can
  Vec3 bounded_N{0.0};     // after the controller
  Vec3 clamped_N{0.0};     // within the arm's limit
  Vec3 sent_N{0.0};        // after the output limiter
  Vec3 energy_out_J{0.0};  // net work of the sent force on the arm so far, by axis: sum F(n-1) dx(n)
  // Of the controller `seed` (0 under another): its observed energy E and its damping [N s/m].
  double observer_J = 0.0;
  double alpha = 0.0;
  // Of the controller `bounded` (0 under another): energy put in and not given back, capped; and
  // the smaller of the scales that it has learnt, 1 where it has learnt nothing.
  double credit_J = 0.0;
  double learnt_scale = 0.0;
  double rendered_share = 1.0;  // |rendered| / |demanded| force, before the controller's force
  double hand_work_J = 0.0;     // the hand's on the tool so far, in the model's units (README.md)
  double stored_J = 0.0;        // of it in springs, which can give it back
  double cutting_credit_J = 0.0;  // work on tissue, not yet spent on removal
  // Where the work went so far (README.md, "Removal"): min(hand_work_J, model_work_J) +
  // motor_work_J = stored_J + removal_work_J + cutting_credit_J + heat_J.
  double model_work_J = 0.0;           // what the model's own force takes from the tool's motion
  double motor_work_J = 0.0;           // of a driven tool while it touches what it may cut
  double removal_work_J = 0.0;         // that voxels cost
  double heat_J = 0.0;                 // all else: friction, damping, credit that faded
  std::uint32_t controller_parts = 0;  // ControllerPart: which parts acted
  std::int32_t tissue_class = -1;
  std::int32_t points_in_tissue = 0;
  std::int32_t removed_voxels = 0;  // in this tick
  std::uint32_t tool_state = 0;     // ToolState
  std::uint32_t faults = 0;
  std::uint32_t buttons = 0;
  std::uint32_t flags = 0;
};

struct TickRecord {
  std::uint64_t tick = 0;
  std::int64_t late_ns = 0;
  std::uint32_t journal = 0;
  std::array<ArmRecord, kMaxArms> arms{};
};

struct CarveRecord {
  std::uint64_t tick = 0;
  std::uint32_t voxel = 0;
  std::int16_t old_hu = 0;
  std::int8_t arm = 0;
  std::int8_t tissue_class = 0;
};

// Everything else that happened, stamped with its tick.
// silenced: the watchdog took the force away before this tick.
// starts_in_tissue: an arm has no force and cuts nothing until it has been out of tissue.
// let_go: a tool that was hooked behind solid tissue went to its arm, which was free.
// tool_changed: from this tick on the arm has another of its tools, by a command or a reset.
enum class EventKind : std::int32_t {
  command,
  fault,
  journal_full,
  stroke_began,
  silenced,
  starts_in_tissue,
  let_go,
  tool_changed
};

struct Event {
  std::uint64_t tick = 0;
  EventKind kind = EventKind::command;
  std::int32_t arm = -1;
  std::uint32_t value = 0;  // fault bits; tool_changed: which of the arm's tools
  Command command{};
};

}  // namespace trephine
