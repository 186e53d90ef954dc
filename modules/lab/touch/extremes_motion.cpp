#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/touch/extremes_rows.h"

namespace trephine::extremes {

namespace {

Outcome zeroVelocity() {
  const Run r = run({.script = [](int) { return Sample{}; }});
  return judge(r, r.largest_N() == 0.0 && r.removed == 1 && r.touching() == kTicks && !r.faulty(),
               facts(r) + ", " + std::to_string(r.touching()) + " ticks in tissue");
}

Outcome denormalVelocity() {
  const Run r = run({.script = [](int tick) {
    Sample sample;
    sample.position_m.x = tick * std::numeric_limits<double>::denorm_min();
    return sample;
  }});
  const double v = r.arm(kMiddle).velocity_m_s.x;
  return judge(r,
               std::fpclassify(v) == FP_SUBNORMAL && r.largest_N() < 1e-9 && r.removed == 1 &&
                   r.touching() == kTicks && !r.faulty(),
               formatted("v = %.3g m/s, ", v) + facts(r));
}

// In and out of the bone, 1 km a tick, each time where it stands yet.
Sample jump(int tick) {
  Sample sample;
  const int place = tick / 2;
  sample.position_m = Vec3(place % 25 - 12, place / 25 + 4, 0) * 1e-3;
  if (tick % 2) sample.position_m.x += 1000.0;
  return sample;
}

Outcome hugeVelocity() {
  const Run r = run({.script = jump});
  double v = 0.0;
  for (int i = 0; i < kTicks; ++i) v = std::max(v, std::abs(r.arm(i).velocity_m_s.x));
  return judge(r, v > 0.99e6 && r.removed == kTicks / 2 && !r.faulty(),
               formatted("v up to %.3g m/s, ", v) + facts(r));
}

Outcome afterHugeVelocity() {
  constexpr int kJumps = 100;
  const Run r =
      run({.script = [](int tick) { return tick < kJumps ? jump(tick) : stroke(tick - kJumps); }});
  double above_N = 0.0;
  int ticks = 0;
  for (int i = kJumps + 1; i < kTicks; ++i) {
    const double more_N = glm::length(r.arm(i).sent_N) - glm::length(r.arm(i).demanded_N);
    above_N = std::max(above_N, more_N);
    ticks += more_N > kFelt_N;
  }
  return judge(
      r, ticks == 0 && r.largest_N(kTicks - 100) > kFelt_N && !r.faulty(),
      formatted("up to %.3g N above the demand, %d ticks with over 0.1 N, ", above_N, ticks) +
          facts(r));
}

Outcome noImpedance() {
  const Run r = run({.tissues = table(0.0, 0.0, 0.0)});
  return judge(
      r, r.largest_N() == 0.0 && !r.faulty() && r.removed == std::uint64_t(voxelsOnTheWay(1.0)),
      facts(r));
}

// Round a circle, so that the limit is met in every direction.
Outcome hugeImpedance() {
  Setup setup;
  setup.script = [](int tick) {
    Sample sample;
    const double turn = 0.01 * tick;
    sample.position_m = 4e-3 * Vec3(std::cos(turn), std::sin(turn), std::sin(2.0 * turn));
    return sample;
  };
  setup.commands = {tissuesAt(100, table(1e9, 1e9, 1e9)),
                    {150, {CommandKind::pause, 0, {}}},
                    {200, {CommandKind::resume, 0, {}}}};
  const Run r = run(setup);
  double demanded_N = 0.0;
  for (int i = 0; i < kTicks; ++i) {
    demanded_N = std::max(demanded_N, glm::length(r.arm(i).demanded_N));
  }
  const bool as_expected =
      demanded_N > 1e5 && r.largest_N(150, 200) == 0.0 && r.largest_N(200) > kFelt_N && !r.faulty();
  return judge(r, as_expected, formatted("%.3g N demanded, ", demanded_N) + facts(r));
}

}  // namespace

std::vector<Case> motionCases() {
  return {
      {"reference", "10 mm through bone at 25 mm/s, b 10, k 800, from within", kStroke,
       [] { return ordinary({}, voxelsOnTheWay(1.0)); }},
      {"v exactly 0", "at rest in bone from the start", "no force, 1 voxel cut, contact held",
       zeroVelocity},
      {"v denormal", "5e-324 m a tick in bone", "v seen, below 1e-9 N, contact held",
       denormalVelocity},
      {"v 1e6 m/s", "200 times into bone and out, 1 km a tick", "every contact cuts, no fault",
       hugeVelocity},
      {"stroke after 1e6 m/s",
       "50 times into bone and out, 1 km a tick, then the reference's stroke",
       "never 0.1 N more than the tissue demands, above 0.1 N at the end, no fault",
       afterHugeVelocity},
      {"b and k 0", "b 0, k 0, friction 0", "no force, 11 voxels cut, no fault", noImpedance},
      {"b and k 1e9", "b, k and friction 1e9 by an edit while circling, then a pause and a resume",
       "above 0.1 N, none in the pause, no fault", hugeImpedance},
  };
}

}  // namespace trephine::extremes
