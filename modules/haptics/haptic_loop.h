// The haptic loop: operator, devices, core, devices, rings, one tick at a time: what was computed
// is sent at once, and waited for the next tick is after that. Run in real time on its own thread
// against a clock, or freewheeled as fast as it goes; both take the same steps.
//
// A call of a device may never return. The loop's thread can then be left behind: it ends by itself
// when the call returns, and touches nothing but the loop and its devices, which it must own with
// the one who leaves it.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "base/rt/event_ring.h"
#include "base/rt/latest_value.h"
#include "device/device.h"
#include "haptics/device_calls.h"
#include "haptics/device_rules.h"
#include "haptics/duration_histogram.h"
#include "haptics/haptic_core.h"
#include "haptics/loop_clock.h"

namespace trephine {

// Where the operator of a simulated arm wants it, and the impedance with which he pulls it there.
struct OperatorSetPoint {
  Pose pose_m;  // device frame
  double stiffness_N_per_m = 0.0;
  double damping_Ns_per_m = 0.0;
};

// Gives the simulated arms their set-points, and timed commands. Haptic thread: no allocation, no
// lock.
class Operator {
 public:
  virtual ~Operator() = default;
  // Fills one set-point an arm for the tick.
  virtual void setPoints(std::uint64_t tick, OperatorSetPoint* of_arms, std::size_t arm_count) = 0;
  // The next command due at or before `tick`, once each; false when there is none.
  virtual bool command(std::uint64_t tick, Command& out) = 0;
  // What a tick came to, and over which maps: before the next set-points.
  virtual void moved(const TickRecord& /*record*/, const HapticParameters& /*now*/) {}
};

// Arms of the core and the device that moves them; or a pedal, whose buttons all arms get.
struct LoopDevice {
  std::unique_ptr<Device> device;
  std::vector<std::size_t> arms;  // device arm i is arm arms[i] of the core; none: a pedal
  bool paces = false;             // its samples are the clock of run(): at most one, hasClock()
  bool real = false;              // a hand may not be on its arms (HandRule)
};

// Looks on, for a measurement. Haptic thread: no allocation, no lock.
class LoopProbe {
 public:
  virtual ~LoopProbe() = default;
  // What an arm of the core gave, and, once its device has it, the force that it was given.
  virtual void sampled(std::size_t arm, const TrephineArmState& state) = 0;
  virtual void sent(std::size_t arm, const Vec3& force_N) = 0;
};

// What the window shows, renewed every tick.
struct LoopState {
  TickRecord record;
  std::uint64_t ticks = 0;
  std::uint64_t missed = 0;
  std::uint64_t nonfinite = 0;
  std::uint64_t dropped = 0;  // records, carves or events that found a full ring
  std::uint64_t removed[kMaxArms][kMaxTissues] = {};  // voxels, undone strokes not counted
  ControllerKind controller = ControllerKind::off;
  bool paused = false;
  bool busy = false;  // an undo, redo or reset is going on
  bool journal_full = false;
  bool can_undo = false;
  bool can_redo = false;
  std::uint32_t seconds = 0;  // without pauses; back to any of which one can rewind
  std::array<WorkspaceMap, kMaxArms> maps{};  // as clutching left them
  // Which of its tools each arm has, 0 the one it started with; which it is to have, another one
  // while that waits until the one in hand is out of tissue.
  std::array<std::int32_t, kMaxArms> tools{}, wanted_tools{};
};

// What of it the core and its last record say: all but `ticks`, `missed` and `dropped`. No
// allocation.
void setState(LoopState& state, const HapticCore& core, const TickRecord& record);

class HapticLoop {
 public:
  // `oper` may be null: then no arm gets a set-point. It outlives the loop, and so does
  // `core` unless the loop's thread is left behind. Ticks count from `first_tick`.
  HapticLoop(HapticCore& core, std::vector<LoopDevice> devices, Operator* oper,
             std::uint64_t first_tick = 0);
  // Before the first tick; it outlives the loop's thread.
  void setProbe(LoopProbe* probe) { probe_ = probe; }

  // Errors: those of the core's parameters and of the devices. Nothing moves before.
  Status startDevices();
  // False when this thread was left behind in it.
  bool stopDevices();

  // One tick, `late_ns` after its deadline. False when this thread was left behind in it: nothing
  // more may be done.
  bool step(std::int64_t late_ns);
  // Steps at every deadline, or sample of the device that paces, until `stop`, until `last_tick`
  // ticks are done, or until this thread is left behind, which is a false.
  bool run(LoopClock& clock, const std::atomic<bool>& stop,
           std::uint64_t last_tick = std::uint64_t(-1));

  // ---- Any thread, beside the one that runs the loop.
  // Zero force on all arms until the loop itself has sent zero, or the next start.
  void silence();
  // The ticks stood still at `tick`, so the force was taken away: an input of the next one.
  void noteSilenced(std::uint64_t tick) { silenced_at_ = tick + 1; }
  // True while no tick has taken that in.
  bool silenceIsPending() const { return silenced_at_ != 0; }
  bool running() const { return running_; }  // run() is at work
  std::uint64_t ticks() const { return tick_; }
  // Leaves the loop's thread behind if it is in a call of a device: which one. Nothing where it is
  // elsewhere, and will come to its end.
  std::optional<std::size_t> leaveBehind() { return calls_.leaveBehind(); }
  // After that: stops and closes the other devices.
  void closeOthers(std::size_t left_behind);
  const std::vector<LoopDevice>& devices() const { return devices_; }

  // The other side of each exchange.
  rt::EventRing<Command>& commands() { return commands_; }
  rt::EventRing<TickRecord>& records() { return records_; }
  rt::EventRing<CarveRecord>& carves() { return carves_; }
  rt::EventRing<Event>& events() { return events_; }
  rt::LatestValue<LoopState>& state() { return state_; }

  std::uint64_t missed() const { return missed_; }
  std::uint64_t dropped() const {
    return records_.dropped() + carves_.dropped() + events_.dropped();
  }
  const DurationHistogram& tickDurations() const { return durations_; }

 private:
  void take(std::size_t arm, const TrephineArmState& state, bool real, std::int64_t now_ns);
  void obey(const Command& command);
  // False when this thread was left behind in it.
  bool read(TickInput& input, std::int64_t now_ns);
  bool write(const TickRecord& record);
  void publish(const TickRecord& record);

  HapticCore& core_;
  std::vector<LoopDevice> devices_;
  Operator* operator_;
  LoopProbe* probe_ = nullptr;
  rt::EventRing<Command> commands_{64};
  rt::EventRing<TickRecord> records_{8192};
  rt::EventRing<CarveRecord> carves_{1 << 18};
  rt::EventRing<Event> events_{1024};
  rt::LatestValue<LoopState> state_;
  DurationHistogram durations_;
  std::vector<TrephineArmState> arm_states_;      // scratch for one device
  std::vector<TrephineArmCommand> arm_commands_;  // scratch for one device
  std::array<ArmSample, kMaxArms> last_samples_{};
  std::array<SilenceRule, kMaxArms> silences_{};
  std::array<HandRule, kMaxArms> hands_{};
  std::array<bool, kMaxArms> lost_by_command_{};
  bool pedal_lost_ = false, without_pedal_ = false;
  bool arms_at_fault_ = false;       // in the last tick; what is asked for is theirs first
  std::atomic<std::uint64_t> tick_;  // only the loop's thread writes it
  std::uint64_t missed_ = 0;
  bool stalled_ = false;          // a tick came more than 20 ms late,
  std::uint64_t last_stall_ = 0;  // last this one
  std::atomic<bool> running_{false};
  std::atomic<std::uint64_t> silenced_at_{0};  // tick + 1; 0: not
  DeviceCalls calls_;                          // those of the loop's thread
};

}  // namespace trephine
