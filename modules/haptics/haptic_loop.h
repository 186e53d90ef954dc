// The haptic loop: operator -> devices -> core -> rings, one tick at a time. Run in real time on its
// own thread against a clock, or freewheeled as fast as it goes; both take the same steps.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "base/rt/event_ring.h"
#include "base/rt/latest_value.h"
#include "device/device.h"
#include "haptics/duration_histogram.h"
#include "haptics/haptic_core.h"
#include "haptics/loop_clock.h"

namespace trephine {

// Where the hand that holds a simulated arm wants to be.
struct HandTarget {
  Pose pose_m;  // device frame
  double stiffness_N_per_m = 0.0;
  double damping_Ns_per_m = 0.0;
};

// Moves the simulated arms' hands and gives timed commands. Haptic thread: no allocation, no lock.
class Operator {
 public:
  virtual ~Operator() = default;
  // Fills one target an arm for the tick.
  virtual void targets(std::uint64_t tick, HandTarget* hands, std::size_t arm_count) = 0;
  // The next command due at or before `tick`, once each; false when there is none.
  virtual bool command(std::uint64_t tick, Command& out) = 0;
};

// An arm of the core and the device that moves it.
struct LoopDevice {
  std::unique_ptr<Device> device;
  std::vector<std::size_t> arms;  // device arm i is arm arms[i] of the core
};

// What the window shows, renewed every tick.
struct LoopState {
  TickRecord record;
  std::uint64_t ticks = 0;
  std::uint64_t missed = 0;
  std::uint64_t nonfinite = 0;
  std::uint64_t dropped = 0;  // records, carves or events that found a full ring
  std::uint64_t removed[kMaxArms][kMaxClasses] = {};  // voxels, undone strokes not counted
  ControllerKind controller = ControllerKind::off;
  bool paused = false;
  bool busy = false;  // an undo, redo or reset is going on
  bool journal_full = false;
  bool can_undo = false;
  bool can_redo = false;
  std::uint32_t seconds = 0;  // back to any of which one can rewind
};

class HapticLoop {
 public:
  // `oper` may be null: then the hands hold where they are. It and `core` outlive the loop.
  // Ticks count from `first_tick`.
  HapticLoop(HapticCore& core, std::vector<LoopDevice> devices, Operator* oper,
             std::uint64_t first_tick = 0);

  Status startDevices();
  void stopDevices();

  // One tick, `late_ns` after its deadline.
  void step(std::int64_t late_ns);
  // Steps at every deadline until `stop`, or until `last_tick` ticks are done.
  void run(LoopClock& clock, const std::atomic<bool>& stop,
           std::uint64_t last_tick = std::uint64_t(-1));

  // The other side of each exchange.
  rt::EventRing<Command>& commands() { return commands_; }
  rt::EventRing<TickRecord>& records() { return records_; }
  rt::EventRing<CarveRecord>& carves() { return carves_; }
  rt::EventRing<Event>& events() { return events_; }
  rt::LatestValue<LoopState>& state() { return state_; }

  std::uint64_t ticks() const { return tick_; }
  std::uint64_t missed() const { return missed_; }
  std::uint64_t dropped() const {
    return records_.dropped() + carves_.dropped() + events_.dropped();
  }
  const DurationHistogram& tickDurations() const { return durations_; }

 private:
  void exchange(TickInput& input);
  void publish(const TickRecord& record);

  HapticCore& core_;
  std::vector<LoopDevice> devices_;
  Operator* operator_;
  rt::EventRing<Command> commands_{64};
  rt::EventRing<TickRecord> records_{8192};
  rt::EventRing<CarveRecord> carves_{1 << 18};
  rt::EventRing<Event> events_{1024};
  rt::LatestValue<LoopState> state_;
  DurationHistogram durations_;
  std::vector<TrephineArmState> arm_states_;      // scratch for one device
  std::vector<TrephineArmCommand> arm_commands_;  // scratch for one device
  std::array<Vec3, kMaxArms> forces_N_{};         // sent in the next exchange
  std::array<ArmSample, kMaxArms> last_samples_{};
  std::uint64_t tick_ = 0;
  std::uint64_t missed_ = 0;
};

}  // namespace trephine
