#include <cmath>

#include "lab/touch/extremes_rows.h"

namespace trephine::extremes {

namespace {

constexpr std::uint64_t kBillion = 1'000'000'000;

Outcome accumulatedEnergy(double energy_J) {
  const Run r = run({.first_tick = kBillion, .energy_out_J = energy_J}), fresh = run({});
  const double grown_J = r.arm(kTicks - 1).energy_out_J.x - energy_J;
  const double expected_J = fresh.arm(kTicks - 1).energy_out_J.x;
  const bool same = sameForces(r, fresh);
  return judge(r,
               same && !r.faulty() && std::abs(grown_J - expected_J) < 1e-7 &&
                   std::abs(expected_J) > 1e-5 && r.trace.back().tick == kBillion + kTicks - 1,
               formatted("%.7g J more after %.7g J, %.7g J in a fresh session, ", grown_J, energy_J,
                         expected_J) +
                   (same ? "the same forces, " : "other forces, ") + facts(r));
}

// One step of 10 m into the bone gives the observer 1 MJ: as 1e9 ticks of 1 mJ would.
Outcome accumulatedObserver() {
  const auto far = strokeWith([](Sample& s) { s.position_m.x -= 10.0; }, 0, 1);
  const Run r = run({.controller = ControllerKind::seed, .first_tick = kBillion, .script = far});
  const double start_J = r.arm(1).observer_J;
  double expected_J = 0.0;
  for (int i = 2; i < kTicks; ++i) {
    expected_J -= 1e-3 * glm::dot(r.arm(i).demanded_N, r.arm(i).velocity_m_s);
  }
  const double grown_J = r.arm(kTicks - 1).observer_J - start_J;
  return judge(
      r,
      start_J > 0.9e6 && expected_J > 1e-4 && std::abs(grown_J - expected_J) < 1e-7 &&
          r.largest_N() > kFelt_N && !r.faulty(),
      formatted("%.7g J more after %.7g J, %.7g J exactly, ", grown_J, start_J, expected_J) +
          facts(r));
}

Outcome vanished() {
  const auto fail = [](Sample& s) { s.answer = TREPHINE_ERROR_NO_DEVICE; };
  // Cleared in vain: the arm is still gone.
  const Run r = run({.script = strokeWith(fail, kMiddle), .commands = {kClearFaults}});
  const int before = r.cut(0, kMiddle);
  const double after_N = r.largest_N(kMiddle);
  const bool stands = r.faultTick(kFaultDeviceLost) == kMiddle &&
                      r.arm(kClear).faults == kFaultDeviceLost &&
                      r.arm(kTicks - 1).faults == kFaultDeviceLost;
  return judge(
      r,
      stands && after_N == 0.0 && before == 6 && r.removed == std::uint64_t(before) &&
          r.largest_N(0, kMiddle) > kFelt_N,
      formatted("%.3g N before and %.3g N after, %d voxels cut before, %d after, a fault that %s",
                r.largest_N(0, kMiddle), after_N, before, r.cut(kMiddle),
                stands ? "stands to the end" : "does not stand"));
}

Outcome lostForAWhile() {
  const auto lose = [](Sample& s) { s.flags |= TREPHINE_ARM_LOST; };
  return faultThenWork(
      {.script = strokeWith(lose, kMiddle, kClear - 20), .commands = {kClearFaults}},
      kFaultDeviceLost, kMiddle);
}

}  // namespace

std::vector<Case> endureCases() {
  return {
      {"1e9 ticks at 1 mW", "first tick 1e9, 1000 J given out along each axis before",
       "a fresh session's forces, the stroke's energy kept to 1e-7 J",
       [] { return accumulatedEnergy(1000.0); }},
      {"1e9 ticks at 1 W", "first tick 1e9, 1e6 J given out along each axis before",
       "a fresh session's forces, the stroke's energy kept to 1e-7 J",
       [] { return accumulatedEnergy(1e6); }},
      {"1e9 ticks in the seed's observer", "first tick 1e9, controller seed, 1e6 J observed before",
       "the stroke's energy kept to 1e-7 J, above 0.1 N, no fault", accumulatedObserver},
      {"device vanishes", "every reading fails from tick 200 on, a clear at 300 in vain",
       "no force from tick 200 on, a fault to the end, the 6 voxels cut before stay cut", vanished},
      {"arm lost for a while", "the plugin reports it lost from tick 200 to 279", kFaultInMiddle,
       lostForAWhile},
  };
}

}  // namespace trephine::extremes
