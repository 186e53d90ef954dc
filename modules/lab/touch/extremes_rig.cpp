#include "lab/touch/extremes_rig.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include "base/rt/alloc_guard.h"

namespace trephine::extremes {

namespace {

constexpr double kPeriod_s = 0.001;
constexpr int kCatchUpTicks = int(kCatchUp_s / kPeriod_s + 0.5);
constexpr int kCatchUpTicksAtStart = int(kCatchUpAtStart_s / kPeriod_s + 0.5);

HapticParameters rigParameters(const Setup& setup, const TrephineCapabilities& capabilities) {
  HapticParameters p;
  const double peak_N = capabilities.peak_force_N;
  p.period_s = kPeriod_s;
  p.arms.push_back({setup.tool,
                    WorkspaceMap{},
                    peak_N,
                    {capabilities.apparent_mass_kg, capabilities.encoder_step_m, peak_N, 0}});
  p.laws = {LawKind::viscous, LawKind::coulomb};
  p.removal = RemovalKind::instant;
  p.controller = setup.controller;
  p.tissues = setup.tissues;
  p.journal_voxels = 100'000;
  p.journal_strokes = 64;
  return p;
}

void runTicks(HapticLoop& loop, const Setup& setup) {
  if (setup.clock) {
    const std::atomic<bool> stop{false};
    loop.run(*setup.clock, stop, setup.first_tick + kTicks);
    return;
  }
  for (int tick = 0; tick < kTicks; ++tick) {
    for (const TimedCommand& c : setup.commands) {
      if (c.tick == tick) loop.commands().push(c.command);
    }
    loop.step(0);
  }
}

std::uint64_t voxelsOfAir(const Volume& volume) {
  return std::uint64_t(std::count(volume.hu.begin(), volume.hu.end(), kAirHu));
}

// The arm must be sent what the record says, in the same tick, and nothing else.
bool wasSent(const std::vector<Vec3>& commanded_N, const std::vector<TickRecord>& trace) {
  bool same = commanded_N.size() == trace.size();
  for (std::size_t i = 0; same && i < trace.size(); ++i) {
    const Vec3& sent_N = trace[i].arms[0].sent_N;
    same = commanded_N[i] == sent_N || !isFinite(sent_N);  // the latter is found elsewhere
  }
  return same;
}

}  // namespace

Sample stroke(int tick) {
  Sample sample;
  // The start keeps voxel borders of the spacings in use away from the ticks.
  sample.position_m = Vec3(-4.91e-3 + 25e-6 * tick, 0.0, 0.0);
  return sample;
}

Volume block(const Index3& size, const Vec3& spacing_mm, std::int16_t hu, const Index3& origin) {
  Volume volume;
  volume.geometry.size = size;
  volume.geometry.spacing_mm = spacing_mm;
  volume.geometry.origin_mm = -Vec3(origin[0], origin[1], origin[2]) * spacing_mm;
  volume.hu.assign(volume.geometry.voxelCount(), hu);
  return volume;
}

Volume block(const Vec3& spacing_mm, std::int16_t hu) {
  return block({32, 32, 32}, spacing_mm, hu, {16, 16, 16});
}

TimedCommand tissuesAt(int tick, const TissueTable& tissues) {
  auto kept = std::make_shared<const TissueTable>(tissues);
  const Command command{CommandKind::tissues, 0, kept.get()};
  return {tick, command, std::move(kept)};
}

TissueTable table(double damping, double stiffness, double friction, int hu_min, int hu_max) {
  TissueTable tissues;
  tissues.count = 1;
  tissues.classes[0] = {{damping, stiffness, friction, 0.0, 0.0}, hu_min, hu_max, 1, 0};
  return tissues;
}

double Run::largest_N(int from, int to) const {
  double largest = 0.0;
  for (int i = from; i < to; ++i) largest = std::max(largest, glm::length(arm(i).sent_N));
  return largest;
}

int Run::cut(int from, int to) const {
  int voxels = 0;
  for (int i = from; i < to; ++i) voxels += arm(i).removed_voxels;
  return voxels;
}

int Run::touching() const {
  int ticks = 0;
  for (int i = 0; i < kTicks; ++i) ticks += arm(i).tissue_class >= 0;
  return ticks;
}

int Run::faultTick(std::uint32_t faults) const {
  for (int i = 0; i < kTicks; ++i) {
    if (arm(i).faults & faults) return i;
  }
  return -1;
}

bool sameForces(const Run& a, const Run& b) {
  for (int i = 0; i < kTicks; ++i) {
    if (a.arm(i).sent_N != b.arm(i).sent_N) return false;
  }
  return a.removed == b.removed;
}

std::string facts(const Run& run) {
  char text[100];
  std::snprintf(text, sizeof(text), "at most %.3g N, %llu %s cut, ", run.largest_N(),
                static_cast<unsigned long long>(run.removed),
                run.removed == 1 ? "voxel" : "voxels");
  const int fault = run.faultTick();
  return text + (fault < 0 ? "no fault" : "a fault in tick " + std::to_string(fault));
}

std::int64_t ScriptedClock::now_ns() {
  const std::int64_t seen_ns = lie_ns && tick() == kMiddle ? *lie_ns : time_ns;
  ++readings;
  return seen_ns;
}

void ScriptedClock::sleepUntil(std::int64_t until_ns) {
  longest_sleep_ms = std::max(longest_sleep_ms, (double(until_ns) - double(time_ns)) / 1e6);
  ++sleeps;
  sleeps_after_middle += tick() > kMiddle;
  time_ns = std::max(time_ns, until_ns);
  if (sleeps == kMiddle) time_ns += jump_ns;
  if (sleeps % 2) time_ns += jitter_ns;
}

Status tryToOpen(const TrephineCapabilities& capabilities) {
  ScriptedArm arm(stroke, capabilities, 0);
  if (auto device = arm.open(); !device) return device.error();
  return {};
}

Run run(const Setup& setup) {
  Run run;
  ScriptedArm arm(setup.script, omniCapabilities(), kTicks);
  auto device = arm.open();
  if (!device) {
    run.broken = device.error().sentence();
    return run;
  }
  const TrephineCapabilities capabilities = (*device)->capabilities(0);
  Grid grid(setup.volume);
  HapticCore core(rigParameters(setup, capabilities), *grid.takeWriter());
  core.setEnergyOut(0, Vec3(setup.energy_out_J));
  std::vector<LoopDevice> devices;
  devices.push_back({*std::move(device), {0}});
  HapticLoop loop(core, std::move(devices), nullptr, setup.first_tick);
  if (Status started = loop.startDevices(); !started) {
    run.broken = started.error().sentence();
    return run;
  }
  const std::uint64_t allocations = rt::guardedAllocations();
  runTicks(loop, setup);
  const bool allocated = rt::guardedAllocations() != allocations;
  loop.stopDevices();

  for (TickRecord& record : run.trace) loop.records().pop(record);
  std::vector<Event> events;
  for (Event event; loop.events().pop(event);) events.push_back(event);
  run.missed = loop.missed();
  for (int c = 0; c < kMaxTissues; ++c) run.removed += core.journal().removed(0, c);

  const std::uint64_t gone = voxelsOfAir(grid.snapshot()) - voxelsOfAir(setup.volume);
  run.broken = brokenBy(run.trace, events, capabilities.peak_force_N);
  if (!run.broken.empty()) return run;
  if (loop.ticks() != setup.first_tick + kTicks || loop.dropped() > 0) {
    run.broken = "not every tick was done and recorded";
  } else if (!wasSent(arm.commanded_N(), run.trace)) {
    run.broken = "the arm was not sent what the record says";
  } else if (gone != run.removed) {
    run.broken = std::to_string(gone) + " voxels are gone, but the journal has " +
                 std::to_string(run.removed);
  } else if (allocated) {
    run.broken = "a tick allocated";
  }
  return run;
}

std::string brokenBy(const std::vector<TickRecord>& trace, const std::vector<Event>& events,
                     double limit_N) {
  const auto isChange = [&](std::uint64_t tick) {
    return std::any_of(events.begin(), events.end(), [&](const Event& e) {
      return e.kind == EventKind::command && e.tick == tick;
    });
  };
  Vec3 before_N(0.0);
  int since_change = kCatchUpTicks - kCatchUpTicksAtStart;
  bool catching_up = true;
  for (const TickRecord& record : trace) {
    const ArmRecord& arm = record.arms[0];
    const auto at = [&](const char* what) {
      return std::string(what) + " in tick " + std::to_string(record.tick);
    };
    const double size_N = glm::length(arm.sent_N);
    if (!isFinite(arm.sent_N)) return at("a force that is not finite was sent");
    if (size_N > limit_N) return at("more than the arm's limit was sent");
    if (!isFinite(arm.energy_out_J) || !isFinite(arm.observer_J) || !isFinite(arm.credit_J)) {
      return at("an energy was not finite");
    }
    if (arm.faults && (size_N > 0.0 || arm.removed_voxels > 0)) {
      return at("the arm acted in spite of a fault");
    }
    if (arm.faults || record.late_ns > kHoldLate_ns || isChange(record.tick)) {
      since_change = 0;
      catching_up = true;
    }
    if (catching_up) {
      const double along_N =
          size_N > 0.0 ? std::max(0.0, glm::dot(before_N, arm.sent_N) / size_N) : 0.0;
      constexpr double kRounding_N = 1e-12;
      if (size_N - along_N > kSlew_N_per_s * kPeriod_s + kRounding_N) {
        return at("the force rose by more than 0.05 N after a change");
      }
      catching_up = ++since_change < kCatchUpTicks || arm.sent_N != arm.clamped_N;
    }
    before_N = arm.sent_N;
  }
  return {};
}

}  // namespace trephine::extremes
