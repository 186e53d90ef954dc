#include <cmath>
#include <limits>

#include "lab/touch/extremes_rows.h"

namespace trephine::extremes {

namespace {

constexpr std::int64_t kFirst_ns = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kLast_ns = std::numeric_limits<std::int64_t>::max();

Outcome clockBack(std::int64_t back_ns) {
  ScriptedClock clock;
  clock.jump_ns = -back_ns;
  Outcome outcome = undisturbed({.clock = &clock});
  outcome.got +=
      formatted(", %d sleeps, the longest %.4g ms", clock.sleeps, clock.longest_sleep_ms);
  outcome.pass = outcome.pass && clock.sleeps == kTicks - 1;
  return outcome;
}

Outcome clockJitter() {
  ScriptedClock clock;
  clock.jitter_ns = 500'000;
  const Run r = run({.clock = &clock});
  const bool same = sameForces(r, run({}));
  return judge(
      r, same && r.missed == 0 && !r.faulty(),
      facts(r) + formatted(", %llu missed, %s forces", static_cast<unsigned long long>(r.missed),
                           same ? "the reference's" : "other"));
}

Outcome clockGap() {
  ScriptedClock clock;
  clock.jump_ns = 10'000'000;
  const Run r = run({.clock = &clock});
  const double before_N = glm::length(r.arm(kMiddle - 1).sent_N);
  const double in_N = glm::length(r.arm(kMiddle).sent_N);
  const bool ramped = std::abs(in_N - before_N * 2.0 / 3.0) < 1e-9;
  return judge(
      r, ramped && before_N > kFelt_N && r.missed == 1 && !r.faulty() && clock.sleeps == kTicks - 1,
      formatted("%.3g N before and %.3g N in the late tick, %llu missed, ", before_N, in_N,
                static_cast<unsigned long long>(r.missed)) +
          facts(r));
}

// Back from the least value the clock leaps on: one tick may be late by it, not all that follow.
Outcome clockLie(std::int64_t lie_ns, bool must_fault) {
  ScriptedClock clock;
  clock.lie_ns = lie_ns;
  const Run r = run({.clock = &clock});
  const bool late = r.faultTick(kFaultLate) >= 0;
  const int after = kTicks - 1 - kMiddle;
  return judge(
      r, (late || !must_fault) && clock.sleeps_after_middle >= after - 1,
      formatted("%s, %d of the %d ticks after it waited for their deadline",
                late ? "late with a fault" : "not late", clock.sleeps_after_middle, after));
}

Outcome clockFromTheFirstValue() {
  ScriptedClock clock;
  clock.time_ns = kFirst_ns;
  Outcome outcome = undisturbed({.clock = &clock});
  outcome.pass = outcome.pass && clock.sleeps == kTicks - 1;
  return outcome;
}

Outcome pluginTime(std::int64_t time_ns) {
  return undisturbed({.script = strokeWith([=](Sample& s) { s.time_ns = time_ns; })});
}

}  // namespace

std::vector<Case> clockCases() {
  return {
      {"clock back 1 ms", "one sleep ends 1 ms early", "no tick early or skipped, the same forces",
       [] { return clockBack(1'000'000); }},
      {"clock back 50 ms", "one sleep ends 50 ms early",
       "no tick early or skipped, the same forces", [] { return clockBack(50'000'000); }},
      {"gap of 10 ms", "one sleep ends 10 ms late",
       "two thirds of the force in that tick, 1 missed, no fault", clockGap},
      {"jitter of half a period", "every second sleep ends 0.5 ms late",
       "none missed, the same forces", clockJitter},
      {"clock from int64's least", "time counts on from -2^63 ns", kAsUsual,
       clockFromTheFirstValue},
      {"clock reads int64's least", "-2^63 ns read in tick 200, then the time again",
       "all ticks after it but one wait for their deadline",
       [] { return clockLie(kFirst_ns, false); }},
      {"clock reads int64's greatest", "2^63 - 1 ns read in tick 200, then the time again",
       "late with a fault, all ticks after it but one wait for their deadline",
       [] { return clockLie(kLast_ns, true); }},
      {"plugin time int64's least", "every sample stamped -2^63 ns", kAsUsual,
       [] { return pluginTime(kFirst_ns); }},
      {"plugin time int64's greatest", "every sample stamped 2^63 - 1 ns", kAsUsual,
       [] { return pluginTime(kLast_ns); }},
  };
}

}  // namespace trephine::extremes
