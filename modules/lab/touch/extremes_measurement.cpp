// Longer than others: each row's function is read beside the table of rows at the end.
#include "lab/touch/extremes_measurement.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>

#include "base/file.h"
#include "lab/touch/extremes_rig.h"
#include "lab/touch/extremes_touch.h"

namespace trephine {

namespace {

using namespace extremes;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNotFinite[] = {kNaN, kInf, -kInf};
constexpr std::int64_t kFirst_ns = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kLast_ns = std::numeric_limits<std::int64_t>::max();
constexpr int kClear = 300;  // the tick in which a row clears its faults
constexpr std::uint64_t kBillion = 1'000'000'000;
constexpr double kFelt_N = 0.1;  // the stroke in bone gives more than this

struct Outcome {
  std::string got;
  bool pass = false;
};

std::string say(const char* format, auto... values) {
  char text[240];
  std::snprintf(text, sizeof(text), format, values...);
  return text;
}

// The voxels that stroke() passes at this spacing.
int voxelsOnTheWay(double spacing_mm) {
  const auto voxel = [&](int tick) {
    return int(std::lround(1000.0 * stroke(tick).position_m.x / spacing_mm));
  };
  return voxel(kTicks - 1) - voxel(0) + 1;
}

Outcome judge(const Run& run, bool as_expected, const std::string& got) {
  if (run.broken.empty()) return {got, as_expected};
  return {got + "; but " + run.broken, false};
}

// The stroke with `change` made to its samples from tick `from` to before `to`.
auto strokeWith(auto change, int from = 0, int to = kTicks) {
  return [=](int tick) {
    Sample sample = stroke(tick);
    if (tick >= from && tick < to) change(sample);
    return sample;
  };
}

// ---- what several rows share

Outcome ordinary(const Setup& setup, int voxels) {
  const Run r = run(setup);
  const bool as_many = std::llabs(std::int64_t(r.removed) - voxels) <= 2;
  return judge(r, r.largest_N() > kFelt_N && !r.faulty() && as_many, facts(r));
}

Outcome nothingTouched(const Setup& setup) {
  const Run r = run(setup);
  return judge(r, r.touching() == 0 && r.largest_N() == 0.0 && r.removed == 0 && !r.faulty(),
               facts(r) + ", " + std::to_string(r.touching()) + " ticks in tissue");
}

// The same tick by tick as without the extreme.
Outcome undisturbed(const Setup& setup) {
  const Run r = run(setup), reference = run({});
  const bool same = sameForces(r, reference);
  return judge(r, same && !r.faulty() && r.largest_N() > kFelt_N,
               facts(r) + (same ? ", the reference's forces" : ", other forces"));
}

// A fault in `tick` that stands until it is cleared, and work as before after it.
Outcome faultThenWork(const Setup& setup, std::uint32_t fault, int tick) {
  const Run r = run(setup);
  const bool stood = r.faultTick(fault) == tick && r.arm(kClear - 1).faults != 0;
  const double after_N = r.largest_N(kClear);
  const int cut = r.cut(kClear);
  const std::string got = (stood ? say("a fault from tick %d to %d", tick, kClear - 1) : facts(r)) +
                          say(", then up to %.3g N and %d voxels cut", after_N, cut);
  return judge(r, stood && r.arm(kClear).faults == 0 && after_N > kFelt_N && cut > 0, got);
}

const TimedCommand kClearFaults{kClear, {CommandKind::clear_faults, 0, {}}};

Outcome badPose(const Vec3& position_m, const Quat& orientation = {1, 0, 0, 0}) {
  const auto spoil = [=](Sample& sample) {
    sample.position_m = position_m;
    sample.orientation = orientation;
  };
  return faultThenWork(
      {.script = strokeWith(spoil, kMiddle, kMiddle + 1), .commands = {kClearFaults}},
      kFaultNonFinite, kMiddle);
}

Vec3 middle_m() {
  return stroke(kMiddle).position_m;
}

// Past the validation: a table that no file and no panel can give.
Outcome badTable(double damping, double stiffness, double friction) {
  Setup setup;
  setup.commands = {{kClear - 1, {CommandKind::tissues, 0, setup.tissues}}, kClearFaults};
  setup.tissues = table(damping, stiffness, friction);
  return faultThenWork(setup, kFaultNonFinite, 0);
}

Outcome pluginTime(std::int64_t time_ns) {
  return undisturbed({.script = strokeWith([=](Sample& s) { s.time_ns = time_ns; })});
}

Tool blade(double length_m, int points) {
  return *makeTool({ToolKind::blade, 1000.0 * length_m, points, 0.05});
}

// ---- clocks

Outcome clockBack(std::int64_t back_ns) {
  ScriptedClock clock;
  clock.jump_ns = -back_ns;
  Outcome outcome = undisturbed({.clock = &clock});
  outcome.got += say(", %d sleeps, the longest %.4g ms", clock.sleeps, clock.longest_sleep_ms);
  outcome.pass = outcome.pass && clock.sleeps == kTicks - 1;
  return outcome;
}

Outcome clockJitter() {
  ScriptedClock clock;
  clock.jitter_ns = 500'000;
  const Run r = run({.clock = &clock});
  const bool same = sameForces(r, run({}));
  return judge(r, same && r.missed == 0 && !r.faulty(),
               facts(r) + say(", %llu missed, %s forces", static_cast<unsigned long long>(r.missed),
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
      say("%.3g N before and %.3g N in the late tick, %llu missed, ", before_N, in_N,
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
  return judge(r, (late || !must_fault) && clock.sleeps_after_middle >= after - 1,
               say("%s, %d of the %d ticks after it waited for their deadline",
                   late ? "late with a fault" : "not late", clock.sleeps_after_middle, after));
}

Outcome clockFromTheFirstValue() {
  ScriptedClock clock;
  clock.time_ns = kFirst_ns;
  Outcome outcome = undisturbed({.clock = &clock});
  outcome.pass = outcome.pass && clock.sleeps == kTicks - 1;
  return outcome;
}

// ---- rows of one value

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
               say("v = %.3g m/s, ", v) + facts(r));
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
               say("v up to %.3g m/s, ", v) + facts(r));
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
      say("up to %.3g N above the demand, %d ticks with over 0.1 N, ", above_N, ticks) + facts(r));
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
  setup.commands = {{100, {CommandKind::tissues, 0, table(1e9, 1e9, 1e9)}},
                    {150, {CommandKind::pause, 0, {}}},
                    {200, {CommandKind::resume, 0, {}}}};
  const Run r = run(setup);
  double demanded_N = 0.0;
  for (int i = 0; i < kTicks; ++i) {
    demanded_N = std::max(demanded_N, glm::length(r.arm(i).demanded_N));
  }
  const bool as_expected =
      demanded_N > 1e5 && r.largest_N(150, 200) == 0.0 && r.largest_N(200) > kFelt_N && !r.faulty();
  return judge(r, as_expected, say("%.3g N demanded, ", demanded_N) + facts(r));
}

TissueSet validSet() {
  Tissue bone;
  bone.id = bone.name = "bone";
  bone.hu_min = 226;
  bone.hu_max = 3071;
  bone.hu_source = bone.damping_Ns_per_m.source = "made up";
  bone.stiffness_N_per_m.source = bone.friction_N.source = "made up";
  bone.cutting_J_per_mm3.source = "made up";
  return {"made up", {bone}};
}

struct Refusals {
  int cases = 0, refused = 0;
  std::string first;
  void add(const auto& answer) {
    ++cases;
    if (!answer && ++refused == 1) first = answer.error().sentence();
  }
  Outcome outcome() const {
    return {say("%d of %d refused: ", refused, cases) + first, refused == cases};
  }
};

Outcome refusedTissues() {
  const Json valid = toJson(validSet());
  if (auto set = parseTissueSet(valid, "file"); !set) return {set.error().sentence(), false};
  Refusals refusals;
  for (double value : kNotFinite) {
    for (auto number : {&Tissue::damping_Ns_per_m, &Tissue::stiffness_N_per_m, &Tissue::friction_N,
                        &Tissue::cutting_J_per_mm3}) {
      TissueSet set = validSet();
      (set.tissues[0].*number).value = value;
      refusals.add(validate(set, "set"));
    }
    TissueSet opaque = validSet(), coloured = validSet();
    opaque.tissues[0].opacity = coloured.tissues[0].colour.y = value;
    refusals.add(validate(opaque, "set"));
    refusals.add(validate(coloured, "set"));
    for (const char* key : {"damping_Ns_per_m", "stiffness_N_per_m", "friction_N"}) {
      Json json = valid;
      json["tissues"][0]["mechanics"][key]["value"] = value;
      refusals.add(parseTissueSet(json, "file"));
    }
  }
  refusals.add(parseJson(R"({"value": 1e999})", "file"));
  return refusals.outcome();
}

Outcome refusedTools() {
  Refusals refusals;
  for (double length_m : kNotFinite) {
    for (ToolKind kind : {ToolKind::needle, ToolKind::blade, ToolKind::burr}) {
      refusals.add(makeTool({kind, 1000.0 * length_m, 10}));
    }
  }
  return refusals.outcome();
}

Outcome refusedCapabilities() {
  if (Status usual = tryToOpen(armCapabilities()); !usual) return {usual.error().sentence(), false};
  Refusals refusals;
  for (double value : kNotFinite) {
    for (auto field : {&TrephineCapabilities::peak_force_N, &TrephineCapabilities::apparent_mass_kg,
                       &TrephineCapabilities::encoder_step_m, &TrephineCapabilities::rate_hz}) {
      TrephineCapabilities capabilities = armCapabilities();
      capabilities.*field = value;
      refusals.add(tryToOpen(capabilities));
    }
  }
  return refusals.outcome();
}

Outcome tissueOf(std::int16_t hu) {
  return ordinary({.volume = block(Vec3(1.0), hu), .tissues = table(10.0, 800.0, 2.0, hu, hu)},
                  voxelsOnTheWay(1.0));
}

Outcome noTissueOf(std::int16_t hu) {
  return nothingTouched({.volume = block(Vec3(1.0), hu)});
}

Outcome spacingOf(double mm, const Index3& size) {
  const Index3 middle{size[0] / 2, size[1] / 2, size[2] / 2};
  return ordinary({.volume = block(size, Vec3(mm), kBoneHu, middle)}, voxelsOnTheWay(mm));
}

Outcome anisotropic() {
  const Volume volume = block(Vec3(0.5, 0.5, 10.0));
  const auto turn = [](Sample& s) { std::swap(s.position_m.x, s.position_m.z); };
  const Outcome x = ordinary({.volume = volume}, voxelsOnTheWay(0.5));
  const Outcome z = ordinary({.volume = volume, .script = strokeWith(turn)}, voxelsOnTheWay(10.0));
  return {"along x " + x.got + "; along z " + z.got, x.pass && z.pass};
}

Outcome oneVoxel() {
  Setup setup{.volume = block({1, 1, 1}, Vec3(1.0), kBoneHu, {0, 0, 0})};
  const Run cut = run(setup);
  setup.tissues.classes[0].cuttable = 0;
  const Run kept = run(setup);
  const Outcome a = judge(cut, cut.removed == 1 && cut.touching() <= 70 && !cut.faulty(),
                          say("%d tick of contact, ", cut.touching()) + facts(cut));
  const Outcome b = judge(
      kept,
      kept.removed == 0 && kept.touching() >= 40 && kept.largest_N() > kFelt_N && !kept.faulty(),
      say("%d ticks of contact, ", kept.touching()) + facts(kept));
  return {a.got + "; not cuttable: " + b.got, a.pass && b.pass};
}

Outcome flatVolume() {
  // To the last voxel of 4,194,304 and beyond it: half of the way lies inside.
  return ordinary({.volume = block({2048, 2048, 1}, Vec3(0.5), kBoneHu, {2047, 2047, 0})}, 11);
}

// Along +x, from the voxel of the tip to the last of the volume.
Outcome longBlade(double length_m, int points) {
  constexpr int kVoxels = 5 + 16;
  const double half = std::sqrt(0.5);
  const auto turn = [=](Sample& s) { s.orientation = Quat(half, 0.0, half, 0.0); };
  return ordinary({.tool = blade(length_m, points), .script = strokeWith(turn)}, kVoxels);
}

Outcome outside() {
  return nothingTouched({.script = strokeWith([](Sample& s) { s.position_m.y = 1.0; })});
}

Outcome accumulatedEnergy(double energy_J) {
  const Run r = run({.first_tick = kBillion, .energy_out_J = energy_J}), fresh = run({});
  const double grown_J = r.arm(kTicks - 1).energy_out_J.x - energy_J;
  const double expected_J = fresh.arm(kTicks - 1).energy_out_J.x;
  const bool same = sameForces(r, fresh);
  return judge(
      r,
      same && !r.faulty() && std::abs(grown_J - expected_J) < 1e-7 && std::abs(expected_J) > 1e-5 &&
          r.trace.back().tick == kBillion + kTicks - 1,
      say("%.7g J more after %.7g J, %.7g J in a fresh session, ", grown_J, energy_J, expected_J) +
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
      say("%.7g J more after %.7g J, %.7g J exactly, ", grown_J, start_J, expected_J) + facts(r));
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
      say("%.3g N before and %.3g N after, %d voxels cut before, %d after, a fault that %s",
          r.largest_N(0, kMiddle), after_N, before, r.cut(kMiddle),
          stands ? "stands to the end" : "does not stand"));
}

Outcome lostForAWhile() {
  const auto lose = [](Sample& s) { s.flags |= TREPHINE_ARM_LOST; };
  return faultThenWork(
      {.script = strokeWith(lose, kMiddle, kClear - 20), .commands = {kClearFaults}},
      kFaultDeviceLost, kMiddle);
}

struct Case {
  const char* name;
  const char* input;
  const char* expected;
  std::function<Outcome()> measure;
};

const char* const kStroke = "above 0.1 N, 11 voxels cut (2 more or less), no fault";
const char* const kAsUsual = "the reference's force in every tick, no fault";
const char* const kFaultInMiddle =
    "a fault from tick 200 until it is cleared, no force meanwhile, force and cutting after it";
const char* const kFaultAtFirst =
    "a fault from the first touch until the table is good and it is cleared, no force meanwhile";
const char* const kRefused = "each refused with a sentence";

std::vector<Case> cases() {
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
      {"position NaN", "y of the position in tick 200", kFaultInMiddle,
       [] { return badPose(Vec3(0.0, kNaN, 0.0)); }},
      {"position infinite", "x of the position in tick 200", kFaultInMiddle,
       [] { return badPose(Vec3(kInf, 0.0, 0.0)); }},
      {"position minus infinite", "z of the position in tick 200", kFaultInMiddle,
       [] { return badPose(Vec3(0.0, 0.0, -kInf)); }},
      {"position 1e308 m", "x of the position in tick 200: finite, its velocity is not",
       kFaultInMiddle, [] { return badPose(Vec3(1e308, 0.0, 0.0)); }},
      {"orientation NaN", "w of the quaternion in tick 200", kFaultInMiddle,
       [] { return badPose(middle_m(), Quat(kNaN, 0.0, 0.0, 0.0)); }},
      {"orientation infinite", "x of the quaternion in tick 200", kFaultInMiddle,
       [] { return badPose(middle_m(), Quat(1.0, kInf, 0.0, 0.0)); }},
      {"orientation minus infinite", "z of the quaternion in tick 200", kFaultInMiddle,
       [] { return badPose(middle_m(), Quat(1.0, 0.0, 0.0, -kInf)); }},
      {"tissue parameters not finite", "NaN, infinity, minus infinity and 1e999 in set and file",
       kRefused, refusedTissues},
      {"tool length not finite", "NaN, infinity and minus infinity", kRefused, refusedTools},
      {"arm capabilities not finite", "NaN, infinity and minus infinity", kRefused,
       refusedCapabilities},
      {"b NaN past validation", "in the core's table", kFaultAtFirst,
       [] { return badTable(kNaN, 800.0, 2.0); }},
      {"b infinite past validation", "in the core's table", kFaultAtFirst,
       [] { return badTable(kInf, 800.0, 2.0); }},
      {"k NaN past validation", "in the core's table", kFaultAtFirst,
       [] { return badTable(10.0, kNaN, 2.0); }},
      {"k infinite past validation", "in the core's table", kFaultAtFirst,
       [] { return badTable(10.0, kInf, 2.0); }},
      {"friction NaN past validation", "in the core's table", kFaultAtFirst,
       [] { return badTable(10.0, 800.0, kNaN); }},
      {"HU -32768 in range", "every voxel, and a tissue of just that HU", kStroke,
       [] { return tissueOf(-32768); }},
      {"HU -32768 out of range", "every voxel, tissue 226 to 3071", "air: no contact, no force",
       [] { return noTissueOf(-32768); }},
      {"HU 32767 in range", "every voxel, and a tissue of just that HU", kStroke,
       [] { return tissueOf(32767); }},
      {"HU 32767 out of range", "every voxel, tissue 226 to 3071", "air: no contact, no force",
       [] { return noTissueOf(32767); }},
      {"spacing 0.05 mm", "256x32x32 voxels",
       "above 0.1 N, 200 voxels cut (2 more or less), no fault",
       [] {
         return spacingOf(0.05, {256, 32, 32});
       }},
      {"spacing 10 mm", "32x32x32 voxels", "above 0.1 N, 2 voxels cut (2 more or less), no fault",
       [] {
         return spacingOf(10.0, {32, 32, 32});
       }},
      {"anisotropy 1:20", "0.5x0.5x10 mm, along x and along z",
       "above 0.1 N, 21 voxels cut along x and 2 along z (2 more or less), no fault", anisotropic},
      {"volume 1x1x1", "the stroke passes its one voxel",
       "cut while it touches; above 0.1 N where it cannot be cut", oneVoxel},
      {"volume 2048x2048x1", "0.5 mm, through the last voxel and out", kStroke, flatVolume},
      {"blade of 0 m", "5 points, all at the tip", kAsUsual,
       [] { return undisturbed({.tool = blade(0.0, 5)}); }},
      {"blade of 1 m", "2001 points, along the stroke and out of the volume",
       "above 0.1 N, the 21 voxels ahead cut, no fault", [] { return longBlade(1.0, 2001); }},
      {"1 point", "blade of 20 mm", kAsUsual, [] { return undisturbed({.tool = blade(0.02, 1)}); }},
      {"10,000 points", "blade of 25 mm, along the stroke",
       "above 0.1 N, the 21 voxels ahead cut, no fault", [] { return longBlade(0.025, 10000); }},
      {"tool outside the volume", "the stroke 1 m beside it", "air: no contact, no force", outside},
      {"1e9 ticks at 1 mW", "first tick 1e9, 1000 J given out along each axis before",
       "a fresh session's forces, the stroke's energy kept to 1e-7 J",
       [] { return accumulatedEnergy(1000.0); }},
      {"1e9 ticks at 1 W", "first tick 1e9, 1e6 J given out along each axis before",
       "a fresh session's forces, the stroke's energy kept to 1e-7 J",
       [] { return accumulatedEnergy(1e6); }},
      {"1e9 ticks in the seed's observer", "first tick 1e9, controller seed, 1e6 J observed before",
       "the stroke's energy kept to 1e-7 J, above 0.1 N, no fault", accumulatedObserver},
      {"device vanishes", "every exchange fails from tick 200 on, a clear at 300 in vain",
       "no force from tick 200 on, a fault to the end, the 6 voxels cut before stay cut", vanished},
      {"arm lost for a while", "the plugin reports it lost from tick 200 to 279", kFaultInMiddle,
       lostForAWhile},
  };
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (char c : text) {
    if (c == '"') out += '"';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  return out + '"';
}

std::string toCsv(const ExtremesMeasurement& measurement) {
  std::string text = "name,input,expected,got,pass\n";
  for (const ExtremeRow& row : measurement.rows) {
    text += quoted(row.name) + ',' + quoted(row.input) + ',' + quoted(row.expected) + ',' +
            quoted(row.got) + ',' + (row.pass ? "true" : "false") + '\n';
  }
  return text;
}

}  // namespace

bool ExtremesMeasurement::all_pass() const {
  return std::all_of(rows.begin(), rows.end(), [](const ExtremeRow& row) { return row.pass; });
}

Result<ExtremesMeasurement> measureExtremes(const std::filesystem::path& out,
                                            const Progress& progress,
                                            const ExtremesOptions& options) {
  if (!out.empty()) {
    if (Status made = makeFolder(out); !made) return made.error();
  }
  ExtremesMeasurement measurement;
  const std::vector<Case> all = cases();
  for (const Case& c : all) {
    const double share = options.touch ? 0.1 : 1.0;
    progress.at(share * double(measurement.rows.size()) / double(all.size()), c.name);
    if (progress.cancelled()) {
      return Error{"CANCELLED", "The measurement was cancelled", "measure extremes", ""};
    }
    const Outcome outcome = c.measure();
    measurement.rows.push_back({c.name, c.input, c.expected, outcome.got, outcome.pass});
  }
  if (options.touch) {
    Result<std::vector<ExtremeRow>> touch =
        measureTouchExtremes(options.case_source, Progress(progress, 0.1, 1.0));
    if (!touch) return touch.error();
    std::move(touch->begin(), touch->end(), std::back_inserter(measurement.rows));
  }
  if (!out.empty()) {
    if (Status written = writeTextFile(out / "extremes.csv", toCsv(measurement)); !written) {
      return written.error();
    }
  }
  progress.at(1.0, "done");
  return measurement;
}

Json toJson(const ExtremesMeasurement& measurement) {
  Json rows = Json::array();
  for (const ExtremeRow& row : measurement.rows) {
    rows.push_back({{"name", row.name},
                    {"input", row.input},
                    {"expected", row.expected},
                    {"got", row.got},
                    {"pass", row.pass}});
  }
  return {{"rows", rows}};
}

std::string toText(const ExtremesMeasurement& measurement) {
  std::string text;
  std::size_t passed = 0;
  for (const ExtremeRow& row : measurement.rows) {
    passed += row.pass;
    text += (row.pass ? "ok     " : "FAILS  ") + row.name + ": " + row.input + "\n";
    if (!row.pass) text += "       expected: " + row.expected + "\n";
    text += "       got: " + row.got + "\n";
  }
  return text + say("%zu of %zu as expected\n", passed, measurement.rows.size());
}

}  // namespace trephine
