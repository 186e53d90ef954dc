// What an extreme value runs in: the real loop, core, controller and device host around an arm that
// answers from a script. And what no tick may do, whatever it is given.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptics/haptic_loop.h"
#include "lab/common/scripted_arm.h"

namespace trephine::extremes {

constexpr int kTicks = 400;          // of a run, 1 ms each
constexpr int kMiddle = kTicks / 2;  // when a script does its worst
constexpr std::int16_t kBoneHu = 1000;

using Sample = ScriptedArm::Sample;

// 10 mm along +x through the middle of the patient at 25 mm/s, tick by tick.
Sample stroke(int tick);

struct TimedCommand {
  int tick = 0;
  Command command;
  std::shared_ptr<const TissueTable> tissues{};  // that the command points to
};
// Other tissues from that tick on.
TimedCommand tissuesAt(int tick, const TissueTable& tissues);

// Nothing but `hu`; the patient's origin is the centre of voxel `origin`.
Volume block(const Index3& size, const Vec3& spacing_mm, std::int16_t hu, const Index3& origin);
Volume block(const Vec3& spacing_mm, std::int16_t hu = kBoneHu);  // 32 voxels a side, middle

TissueTable table(double damping, double stiffness, double friction, int hu_min = 226,
                  int hu_max = 3071);

struct Setup {
  Volume volume = block(Vec3(1.0));
  // As thin as a tool can be, so that it takes what its points touch.
  Tool tool = *makeTool({ToolKind::needle, 50.0, 1, 0.05});
  TissueTable tissues = table(10.0, 800.0, 2.0);
  ControllerKind controller = ControllerKind::bounded;
  std::uint64_t first_tick = 0;
  double energy_out_J = 0.0;                        // of each axis, of the session so far
  std::function<Sample(int tick)> script = stroke;  // haptic thread: no allocation
  std::vector<TimedCommand> commands{};             // freewheeling only, one a tick
  LoopClock* clock = nullptr;                       // freewheels without one
};

struct Run {
  std::vector<TickRecord> trace = std::vector<TickRecord>(kTicks);
  std::uint64_t removed = 0;  // voxels
  std::uint64_t missed = 0;
  std::string broken;  // the first thing that no run may do; empty when all was kept

  const ArmRecord& arm(int tick) const { return trace[std::size_t(tick)].arms[0]; }
  // In the ticks [from, to).
  double largest_N(int from = 0, int to = kTicks) const;
  int cut(int from, int to = kTicks) const;
  int touching() const;
  // The first tick with one of these faults, -1 without.
  int faultTick(std::uint32_t faults = ~0u) const;
  bool faulty() const { return faultTick() >= 0; }
};

// The same force in every tick, and as many voxels.
bool sameForces(const Run& a, const Run& b);
// The largest force, the voxels, the first fault.
std::string facts(const Run& run);

Run run(const Setup& setup);

// The first thing in a trace of arm 0 that no tick may do, as a clause; empty when there is none.
// Sent forces are finite and at most `limit_N`, energies are finite, a fault lets nothing act, and
// after a change the sent force rises no faster than the output limiter's limit until it meets the
// law. `events`: the commands among them are the changes, besides the start.
std::string brokenBy(const std::vector<TickRecord>& trace, const std::vector<Event>& events,
                     double limit_N);

// Takes no time of its own.
struct ScriptedClock : LoopClock {
  std::int64_t time_ns = 7'000'000'000;
  std::int64_t jump_ns = 0;            // the sleep in the middle ends this much later
  std::int64_t jitter_ns = 0;          // every second sleep ends this much later
  std::optional<std::int64_t> lie_ns;  // read, not the time, throughout the tick in the middle
  int readings = 0, sleeps = 0, sleeps_after_middle = 0;
  double longest_sleep_ms = 0.0;

  int tick() const { return readings / 2; }  // the schedule reads twice a tick
  std::int64_t now_ns() override;
  void sleepUntil(std::int64_t until_ns) override;
};

// Whether a scripted arm with these can be opened; its own are an Omni's.
Status tryToOpen(const TrephineCapabilities& capabilities);

}  // namespace trephine::extremes
