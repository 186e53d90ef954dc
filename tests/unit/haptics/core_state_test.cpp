// The core's state as a value: whoever loads it goes on, bit for bit, as the one that saved it.
#include <cstring>
#include <deque>
#include <functional>
#include <limits>
#include <memory>

#include "device/trephine_device.h"
#include "strokes_support.h"

namespace trephine {
namespace {

constexpr std::int16_t kSkinHu = 300, kMetalHu = 2500;

// Liver under a skin that ruptures, bone under the liver, a lump of metal in the bone.
Volume layers(double voxel_mm) {
  Volume volume;
  GridGeometry& g = volume.geometry;
  g.size.fill(int(24.0 / voxel_mm));
  g.spacing_mm = Vec3(voxel_mm);
  g.origin_mm = Vec3(-12.0 + 0.5 * voxel_mm);
  volume.hu.assign(g.voxelCount(), kAirHu);
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    const Index3 v = g.indicesOf(n);
    const Vec3 p = g.origin_mm + voxel_mm * Vec3(v[0], v[1], v[2]);
    const double depth = 0.15 * p.x - 0.1 * p.y - p.z;
    const bool half = p.x > 0.0;  // here bone lies open
    if (depth > 0.0 && !half) volume.hu[n] = depth < 1.0 ? kSkinHu : test::kLiverHu;
    if (depth > (half ? 0.0 : 4.0)) volume.hu[n] = test::kBoneHu;
    if (glm::length(p - Vec3(4.0, 4.0, -3.0)) < 2.0) volume.hu[n] = kMetalHu;
  }
  return volume;
}

// damping, stiffness, friction, rupture, cutting energy; HU; cuttable, label, solid.
TissueTable tissues(double firmer = 1.0) {
  TissueTable t;
  t.count = 4;
  t.classes[0] = {{4.0, 120.0 * firmer, 0.35, 0.0, 5e-6}, 0, 225, 1, 0, 0};
  t.classes[1] = {{6.0, 400.0 * firmer, 0.5, 0.4, 2e-5}, 226, 400, 1, 0, 0};
  t.classes[2] = {{12.0, 900.0 * firmer, 2.0, 0.0, 2e-3}, 401, 2000, 1, 0, 1};
  t.classes[3] = {{12.0, 2500.0, 1.0, 0.0, 1.0}, 2001, 3071, 0, 0, 1};
  return t;
}

// What came into a core tick by tick, and what came out of it.
struct Tick {
  TickInput input;
  std::vector<Command> commands;
  TickRecord record;
  std::vector<Event> events;
  std::vector<CarveRecord> carves;
  // Of the core after it: the journal's seconds and state, samples that were no numbers, what it is
  // in and which tools are in hand.
  std::vector<std::uint64_t> after;
};

std::vector<std::uint64_t> afterOf(HapticCore& core) {
  return {core.journal().seconds(),
          core.journalState(),
          core.nonFinite(),
          core.paused(),
          std::uint64_t(core.controller()),
          core.acceptsCommands(),
          core.unknownBricks(),
          core.toolInHand(0),
          core.toolInHand(1),
          core.toolWanted(0),
          core.toolWanted(1),
          core.journalFull()};
}

// A core in the middle of its run: all that another needs to go on as it does.
struct Moment {
  std::size_t tick = 0;
  std::vector<std::byte> state;
  Volume volume;
  std::vector<CarveEntry> log;
};

struct Core {
  Core(const HapticParameters& parameters, Volume volume)
      : grid(std::move(volume)), core(parameters, *grid.takeWriter()) {}
  Grid grid;
  HapticCore core;
};

Moment momentOf(Core& at, std::size_t tick) {
  Moment moment{tick, at.core.save(), at.grid.snapshot(), {}};
  const CarveLog& log = at.core.journal().log();
  for (std::uint64_t n = 0; n < log.size(); ++n) moment.log.push_back(log.at(n));
  return moment;
}

// A fresh core on a copy of the volume; its state is its own yet.
std::unique_ptr<Core> placed(const HapticParameters& parameters, const Moment& moment) {
  auto out = std::make_unique<Core>(parameters, moment.volume);
  for (const CarveEntry& entry : moment.log) out->core.journal().log().append(entry);
  return out;
}

template <class T>
bool sameBits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}
bool sameEvent(const Event& a, const Event& b) {
  return a.tick == b.tick && a.kind == b.kind && a.arm == b.arm && a.value == b.value &&
         a.command.kind == b.command.kind && a.command.value == b.command.value &&
         a.command.arm == b.command.arm && a.command.tissues == b.command.tissues;
}

// An arm in a hand that goes from place to place; it need not be what the core was told of it.
struct HandArm {
  double mass_kg = 0.045, step_m = 0.0;
  bool calm = false;  // presses, rests and creeps, trembling by a count
  std::deque<Vec3> on_the_way_N;
  Vec3 at_m{0.0}, speed_m_s{0.0}, from_mm{0.0, 0.0, 9.0}, to_mm{0.0, 0.0, 9.0};
  Vec3 lean_from{0.0}, lean_to{0.0};
  double t_s = 0.0, for_s = 0.2;

  void newPlace(test::Random& random) {
    from_mm = to_mm;
    lean_from = lean_to;
    t_s = 0.0;
    const int what = random.below(7);
    for_s = what == 0 ? 0.4 : random.in(0.05, 0.3);
    if (what == 0) return;  // rests where it is
    const double low = what < 4 ? random.in(-6.0, -1.0) : what < 5 ? random.in(-1.5, 0.5) : 9.0;
    if (calm && what < 5) {
      for_s = random.in(0.3, 1.0);
      const bool lowers = to_mm.z > 0.0;
      to_mm += Vec3(random.in(-1, 1), random.in(-1, 1), lowers ? random.in(-12, -9) : 0.0);
      return;
    }
    to_mm = {random.in(-6, 6), random.in(-6, 6), low};
    lean_to = {random.in(-0.5, 0.5), random.in(-0.5, 0.5), random.in(-0.5, 0.5)};
  }
  ArmSample next(double T, const Vec3& sent_N, test::Random& random) {
    if ((t_s += T) > for_s) newPlace(random);
    const double way = std::min(1.0, t_s / for_s), part = way * way * (3.0 - 2.0 * way);
    Vec3 goal_m = 0.001 * (from_mm + part * (to_mm - from_mm));
    if (calm) goal_m[random.below(3)] += random.in(-2.0, 2.0) * step_m;
    on_the_way_N.push_back(sent_N);
    const Vec3 force_N = on_the_way_N.front();
    on_the_way_N.pop_front();
    const int steps = std::max(20, int(T / 5e-5));
    for (int n = 0; n < steps; ++n) {
      const Vec3 hand_N = 1000.0 * (goal_m - at_m) - 10.0 * speed_m_s;
      speed_m_s += T / steps / mass_kg * (hand_N + force_N);
      at_m += T / steps * speed_m_s;
    }
    ArmSample sample;
    sample.position_m = step_m > 0.0 ? step_m * glm::round(at_m / step_m) : at_m;
    sample.orientation = test::turned(lean_from + part * (lean_to - lean_from));
    return sample;
  }
};

// Two arms, whatever their tools, laws, controllers and commands. Of three scripts one is calm,
// with hands that press, and one has trouble: arms that fail and ticks that come late. From the
// thirteenth on tools touch by their points alone.
struct Script {
  Script(unsigned seed, std::size_t count)
      : random(seed), calm(seed % 3 == 1), trouble(seed % 3 == 2) {
    make();
    if (seed > 12) touchByPoints();
    Core at(parameters, volume());
    for (std::size_t n = 0; n < count; ++n) tick(at);
  }

  Volume volume() const { return layers(voxel_mm); }

  void make() {
    using test::tool;
    voxel_mm = random.of({0.5, 0.5, 0.25});
    parameters = test::oneArm();
    HapticParameters& p = parameters;
    p.period_s = random.of({0.001, 0.001, 0.0005, 0.002});
    if (trouble) p.period_s = random.of({0.01, 0.01, 0.002});
    p.tissues = tissues();
    p.journal_voxels = random.below(4) == 0 ? 3000 : 200'000;
    p.journal_seconds = 600;
    p.stroke_gap_s = 0.05;
    p.force_at = random.below(4) == 0 ? ForceAt::tip : ForceAt::distributed;
    p.removal = random.below(4) == 0 ? RemovalKind::instant : RemovalKind::work;
    p.controller = random.below(4) > 0 ? ControllerKind::bounded : ControllerKind::seed;
    p.laws.clear();
    for (const auto& [name, law] : kLawNames) p.laws.push_back(law);
    if (random.below(4) == 0) std::erase(p.laws, LawKind::elastic);
    const std::vector<Tool> all{
        tool(ToolKind::needle, 40.0, 0.9, 0.0), tool(ToolKind::blade, 16.0, 0.6, 6.0),
        tool(ToolKind::blade, 16.0, 0.6, 0.0), tool(ToolKind::burr, 30.0, 3.0, 4.0),
        tool(ToolKind::burr, 20.0, 2.0, 4.0, BurrShape::cylinder)};
    p.arms.clear();
    for (int i = 0; i < 2; ++i) {
      ArmParameters arm{all[std::size_t(random.below(5))], WorkspaceMap{}, 3.3, ArmDynamics{}};
      for (int n = 0; n < 2; ++n) arm.other_tools.push_back(all[std::size_t(random.below(5))]);
      arm.dynamics.apparent_mass_kg = random.of({0.02, 0.045, 0.2});
      arm.dynamics.encoder_step_m = random.of({0.0, 5.5e-5, 2e-4});
      arm.dynamics.delay_s = p.period_s * random.of({0.0, 0.0, 1.5});
      if (random.below(3) == 0) {
        arm.dynamics.thermal_s = 2.0;
        arm.dynamics.continuous_force_N = 0.5;
      }
      HandArm& hand = hands[std::size_t(i)];
      hand.mass_kg = arm.dynamics.apparent_mass_kg / random.of({1.0, 1.0, 4.0});
      hand.step_m = arm.dynamics.encoder_step_m;
      hand.calm = calm;
      hand.on_the_way_N.assign(std::size_t(random.below(3)), Vec3(0.0));
      p.arms.push_back(arm);
    }
    softer = tissues(0.5);
    other = tissues(1.5);
    other.classes[1].hu_max = 350;
    uncut = tissues();
    uncut.classes[2].cuttable = 0;
  }

  // The seed paper's rule, of bone and liver.
  void touchByPoints() {
    parameters.laws = {LawKind::viscous};
    parameters.force_at = ForceAt::tip;
    parameters.removal = RemovalKind::instant;
    parameters.touch_by_points = 0b101;
  }

  void tick(Core& at) {
    HapticCore& core = at.core;
    Tick now;
    const double T = parameters.period_s;
    now.input.tick = ticks.size();
    now.input.journal = core.journalState();
    for (std::size_t i = 0; i < 2; ++i) {
      const Vec3 sent_N = ticks.empty() ? Vec3(0.0) : ticks.back().record.arms[i].sent_N;
      now.input.arms[i] = hands[i].next(T, sent_N, random);
      ArmSample& sample = now.input.arms[i];
      sample.buttons = kPedalThere | (random.below(2000) ? kPedalMiddle : 0u);
      if (random.below(1500) == 0) warm[i] = !warm[i];
      if (random.below(1500) == 0) no_hand_until[i] = now.input.tick + 20;
      if (warm[i]) sample.flags |= TREPHINE_ARM_WARM;
      if (now.input.tick < no_hand_until[i]) sample.flags |= TREPHINE_ARM_NO_HAND;
      if (random.below(300) == 0) sample.position_m.y += 0.012;  // jumps for a tick
      if (!trouble) continue;
      if (random.below(500) == 0) sample.flags |= TREPHINE_ARM_ERROR;
      if (random.below(4000) == 0) sample.flags |= TREPHINE_ARM_LOST;
      if (random.below(2000) == 0) {
        sample.position_m.x = std::numeric_limits<double>::quiet_NaN();
      }
    }
    if (trouble && random.below(200) == 0) now.input.late_ns = random.below(24) * 1'000'000;
    if (trouble && random.below(900) == 0) now.input.late_ns = 25'000'000;
    if (trouble && random.below(2500) == 0) now.input.silenced = true;
    if (random.below(400) == 0) full_until = now.input.tick + 12;
    if (now.input.tick < full_until) now.input.journal &= ~std::uint32_t(kJournalRoom);
    if (random.below(3) == 0) now.input.journal &= ~std::uint32_t(kJournalReady);
    if (core.acceptsCommands() && random.below(calm ? 800 : 160) == 0) command(core, now);
    core.tick(now.input, now.commands.data(), now.commands.size(), now.record);
    now.events = core.events();
    now.carves = core.carves();
    now.after = afterOf(core);
    ticks.push_back(std::move(now));
  }

  void command(HapticCore& core, Tick& now) {
    Command c;
    c.arm = random.below(2);
    c.rotation = test::turned({random.in(-0.3, 0.3), 0.0, random.in(-0.3, 0.3)});
    const auto add = [&](CommandKind kind, std::int32_t value = 0) {
      c.kind = kind;
      c.value = value;
      now.commands.push_back(c);
    };
    if (core.paused()) return add(CommandKind::resume);
    if (!ticks.empty() && random.below(4)) {  // mostly the arms are free
      for (c.arm = 0; c.arm < 2; ++c.arm) {
        const ArmRecord& arm = ticks.back().record.arms[std::size_t(c.arm)];
        if (arm.faults & ~kPassingFaults) return add(CommandKind::clear_faults);
        if (arm.tool_state & kToolClutched) return add(CommandKind::clutch_off, random.below(2));
      }
      c.arm = random.below(2);
    }
    switch (random.below(20)) {
      case 0:
      case 1:
      case 2:
        return add(CommandKind::undo);
      case 3:
      case 4:
        return add(CommandKind::redo);
      case 5:
        return add(CommandKind::rewind, random.below(int(core.journal().seconds()) + 1));
      case 6:
        return random.below(3) ? void() : add(CommandKind::reset);
      case 7:
        return add(CommandKind::pause);
      case 8:
        return add(CommandKind::controller, random.below(3));
      case 9:
        return add(CommandKind::controller, int(ControllerKind::bounded));
      case 10:
        c.tissues =
            std::array{&softer, &other, &uncut, &parameters.tissues}[std::size_t(random.below(4))];
        return add(CommandKind::tissues);
      case 11:
        return add(CommandKind::clear_faults);
      case 12:
      case 13:
      case 14:
        return add(CommandKind::clutch_on);
      case 15:
      case 16:
        return add(CommandKind::clutch_off, random.below(2));
      case 17:
        return add(CommandKind::recentre, random.below(2));
      default:
        return add(CommandKind::tool, random.below(3));
    }
  }

  test::Random random;
  bool calm, trouble;
  HapticParameters parameters;
  TissueTable softer, other, uncut;
  std::array<HandArm, 2> hands;
  std::array<bool, 2> warm{};
  std::array<std::uint64_t, 2> no_hand_until{};
  std::uint64_t full_until = 0;
  double voxel_mm = 0.5;
  std::vector<Tick> ticks;
};

// Whether this core gives in each of the ticks up to `end` what was given in the run; else where it
// first does not.
std::string differsFrom(const std::vector<Tick>& ticks, Core& at, std::size_t first,
                        std::size_t end) {
  TickRecord record;
  for (std::size_t n = first; n < end; ++n) {
    const Tick& then = ticks[n];
    at.core.tick(then.input, then.commands.data(), then.commands.size(), record);
    const std::string where =
        " in tick " + std::to_string(n) + ", loaded before " + std::to_string(first);
    for (std::size_t i = 0; i < 2; ++i) {
      if (!sameBits(record.arms[i], then.record.arms[i])) return "arm " + std::to_string(i) + where;
    }
    const auto same = [](const auto& a, const auto& b, auto equal) {
      return std::equal(a.begin(), a.end(), b.begin(), b.end(), equal);
    };
    if (!same(at.core.events(), then.events, sameEvent)) return "events" + where;
    if (!same(at.core.carves(), then.carves, sameBits<CarveRecord>)) return "carves" + where;
    if (afterOf(at.core) != then.after) return "what it says of itself" + where;
  }
  return "";
}

// The script as it goes by once more: `look` sees each of its moments.
void watch(const Script& script, std::size_t every,
           const std::function<void(const Moment&)>& look) {
  Core at(script.parameters, script.volume());
  for (std::size_t n = 0; n < script.ticks.size() && !testing::Test::HasFailure(); ++n) {
    const bool after_command = n > 0 && !script.ticks[n - 1].commands.empty();
    if (n % every == every - 1 || after_command) look(momentOf(at, n));
    ASSERT_EQ(differsFrom(script.ticks, at, n, n + 1), "") << "a script is the same each time";
  }
}

class CoreState : public testing::TestWithParam<unsigned> {};

constexpr std::size_t kTicks = 3000;

// Something else for the core to do: it removes nothing and its log stays, so that it can load the
// same moment again.
void useOtherwise(const Script& script, Core& at, std::size_t tick) {
  TickRecord record;
  for (std::size_t n = 0; n < 30; ++n) {
    const Tick& other = script.ticks[(tick + script.ticks.size() / 3 + n) % script.ticks.size()];
    TickInput input = other.input;
    input.journal = 0;
    at.core.tick(input, other.commands.data(), other.commands.size(), record);
  }
}

// Whether a core that loads the one moment comes to the other: with the same outcome on the way,
// and then with the same state and voxels.
void expectOneComesToTheOther(const Script& script, const Moment& one, const Moment& other,
                              bool used_before) {
  const auto at = placed(script.parameters, one);
  const auto load = [&] {
    const Status loaded = at->core.load(one.state);
    ASSERT_TRUE(loaded) << loaded.error().sentence();
  };
  load();
  if (used_before) {
    useOtherwise(script, *at, one.tick);
    load();
  }
  ASSERT_EQ(differsFrom(script.ticks, *at, one.tick, other.tick), "")
      << (used_before ? "by a core that was used before" : "by a fresh core");
  ASSERT_TRUE(at->core.save() == other.state)
      << "another state in tick " << other.tick << ", loaded before " << one.tick;
  ASSERT_TRUE(at->grid.snapshot().hu == other.volume.hu);
}

// For a short while from many ticks, for a long one from some.
TEST_P(CoreState, GoesOnBitForBitFromAnyTick) {
  SCOPED_TRACE("script " + std::to_string(GetParam()));
  const Script script(GetParam(), kTicks);
  std::deque<Moment> before;
  int looks = 0;
  watch(script, 59, [&](const Moment& now) {
    if (++looks > 1) expectOneComesToTheOther(script, before.back(), now, looks % 2 == 0);
    if (looks % 12 == 0) expectOneComesToTheOther(script, before.front(), now, looks % 24 == 0);
    before.push_back(now);
    if (before.size() > 12) before.pop_front();
  });
  EXPECT_GT(looks, 50);
}
// Some that are soon run, one by points alone among them, and the others.
INSTANTIATE_TEST_SUITE_P(Some, CoreState, testing::Values(4u, 5u, 10u, 14u));
INSTANTIATE_TEST_SUITE_P(All, CoreState, testing::Range(1u, 13u));

TEST(CoreStateValue, IsTheSameAfterItWasLoadedAndAfterTheSameTicks) {
  const Script script(4, 1200);
  std::vector<Moment> moments;
  watch(script, 100, [&](const Moment& moment) { moments.push_back(moment); });
  ASSERT_GT(moments.size(), 10u);
  for (const Moment& moment : moments) {
    const auto fresh = placed(script.parameters, moment);
    ASSERT_TRUE(fresh->core.load(moment.state));
    EXPECT_TRUE(fresh->core.save() == moment.state) << moment.tick;
  }
  expectOneComesToTheOther(script, moments[moments.size() / 2], moments.back(), false);
}

// What no script comes to: commands in the same tick as a pose that is none, which wait for one,
// and tables of tissues that differ in every member.
TEST(CoreStateValue, GoesOnFromCommandsThatWaitForAPoseAndFromOtherTissues) {
  HapticParameters p = test::oneArm();
  p.arms.push_back(p.arms[0]);
  p.controller = ControllerKind::bounded;
  p.laws = {LawKind::viscous, LawKind::coulomb, LawKind::elastic};
  p.tissues.classes[0].solid = 1;
  p.tissues.classes[0].cuttable = 0;
  TissueTable other = p.tissues;
  other.count = 2;
  other.classes[0].hu_min = 400;
  other.classes[1] = {{4.0, 300.0, 0.3, 0.0, 1.0}, 500, 1000, 0, 0, 0};
  TissueTable unlike = other;  // no voxel has this label
  unlike.classes[0].label = 3;
  unlike.classes[1].solid = 1;
  unlike.classes[1].hu_max = 3071;

  Core ran(p, test::boneSlab());
  std::vector<Tick> ticks;
  std::vector<Moment> moments;
  for (std::size_t n = 0; n < 480; ++n) {
    moments.push_back(momentOf(ran, n));
    Tick now;
    const auto add = [&](CommandKind kind, std::int32_t value = 0, std::int32_t arm = 1) {
      Command command;
      command.kind = kind;
      command.value = value;
      command.arm = arm;
      command.rotation = test::turned({0.2, 0.1, 0.0});
      command.tissues = n < 450 ? &other : &unlike;
      now.commands.push_back(command);
    };
    now.input.tick = n;
    now.input.journal = ran.core.journalState();
    const double z_mm = n < 50    ? 5.0 - 0.5 * double(n)
                        : n < 400 ? -20.0
                                  : 6.0 - 0.1 * double(n - 400);
    now.input.arms[0].position_m = 0.001 * Vec3(2.0, 0.0, z_mm);
    now.input.arms[1].position_m = 0.001 * Vec3(-5.0, 0.0, 3.0 - 0.01 * double(n % 400));
    switch (n) {
      case 20:
        add(CommandKind::clutch_on);
        break;
      case 40:
        add(CommandKind::clutch_off, 1);
        break;
      case 60:
        add(CommandKind::recentre, 0);
        break;
      case 80:
        add(CommandKind::recentre, 1);
        break;
      case 380:
      case 400:
        add(CommandKind::clear_faults);
        break;
      case 430:
      case 450:
        add(CommandKind::tissues);
        break;
      default:
        break;
    }
    if (n == 40 || n == 60 || n == 80 || n == 380) {
      now.input.arms[1].position_m.x = std::numeric_limits<double>::quiet_NaN();
    }
    ran.core.tick(now.input, now.commands.data(), now.commands.size(), now.record);
    now.events = ran.core.events();
    now.carves = ran.core.carves();
    now.after = afterOf(ran.core);
    ticks.push_back(std::move(now));
  }
  for (std::size_t n = 0; n < ticks.size(); ++n) {
    const bool after_command = n > 0 && !ticks[n - 1].commands.empty();
    if (n % 40 != 0 && !after_command) continue;
    const auto fresh = placed(p, moments[n]);
    ASSERT_TRUE(fresh->core.load(moments[n].state));
    ASSERT_EQ(differsFrom(ticks, *fresh, n, ticks.size()), "");
  }
}

// The scripts come to everything that a state is made of.
TEST(CoreStateValue, IsTriedOnCutsUndonePausesClutchesToolsAndFaults) {
  std::uint64_t carves = 0, waits = 0, held = 0, clutched = 0, to_come = 0, warm = 0;
  std::uint32_t faults = 0, parts = 0;
  std::array<int, 16> commands{}, events{};
  for (unsigned seed = 1; seed < 13; ++seed) {
    const Script run(seed, kTicks);
    for (const Tick& tick : run.ticks) {
      carves += tick.carves.size();
      for (const Command& command : tick.commands) ++commands[std::size_t(command.kind)];
      for (const Event& event : tick.events) ++events[std::size_t(event.kind)];
      for (std::size_t i = 0; i < 2; ++i) {
        const ArmRecord& arm = tick.record.arms[i];
        waits += (arm.tool_state & kToolWaits) != 0;
        held += (arm.tool_state & kToolHeld) != 0;
        clutched += (arm.tool_state & kToolClutched) != 0;
        to_come += (arm.tool_state & kToolToCome) != 0;
        warm += (arm.tool_state & kToolArmWarm) != 0;
        faults |= arm.faults;
        parts |= arm.controller_parts;
      }
    }
  }
  EXPECT_GT(carves, 10'000u);
  for (std::uint64_t ticks : {waits, held, clutched, to_come, warm}) EXPECT_GT(ticks, 500u);
  for (int kind = int(CommandKind::undo); kind <= int(CommandKind::tool); ++kind) {
    EXPECT_GT(commands[std::size_t(kind)], 1) << kind;
  }
  for (EventKind kind : {EventKind::fault, EventKind::journal_full, EventKind::stroke_began,
                         EventKind::silenced, EventKind::tool_changed}) {
    EXPECT_GT(events[std::size_t(kind)], 2) << int(kind);
  }
  EXPECT_EQ(faults, kFaultNonFinite | kFaultLate | kFaultDeviceLost | kFaultStalled | kFaultDevice |
                        kFaultDeviceOften);
  EXPECT_EQ(parts, 2u * kPartArmNotAsStated - 1u);
}

TEST(CoreStateValue, RefusesWhatIsNotItsOwnAndStaysAsItWas) {
  const Script run(6, 1500);
  Moment moment;
  watch(run, 100, [&](const Moment& now) { moment = now; });
  ASSERT_FALSE(moment.log.empty());
  const auto fresh = placed(run.parameters, moment);
  const std::vector<std::byte> before = fresh->core.save();
  const auto refused = [&](Core& at, std::span<const std::byte> bytes) {
    const Status loaded = at.core.load(bytes);
    return !loaded && loaded.error().code.str() == "BAD_STATE";
  };
  std::vector<std::byte> bytes = moment.state;
  for (std::size_t length : {std::size_t(0), std::size_t(20), bytes.size() / 2, bytes.size() - 1}) {
    EXPECT_TRUE(refused(*fresh, std::span(bytes).first(length))) << length;
  }
  bytes.push_back(std::byte{});
  EXPECT_TRUE(refused(*fresh, bytes)) << "longer";
  bytes.pop_back();
  for (std::size_t at : {std::size_t(0), std::size_t(8), std::size_t(30), bytes.size() / 2}) {
    bytes[at] ^= std::byte{1};
    EXPECT_TRUE(refused(*fresh, bytes)) << "another byte " << at;
    bytes[at] ^= std::byte{1};
  }
  EXPECT_TRUE(fresh->core.save() == before);

  Core elsewhere(run.parameters, moment.volume);  // its log is empty
  EXPECT_TRUE(refused(elsewhere, bytes));
  Moment uncut = moment;
  uncut.volume = run.volume();
  EXPECT_TRUE(refused(*placed(run.parameters, uncut), bytes));
  using Change = void (*)(HapticParameters&);
  constexpr Change kChanges[] = {
      [](HapticParameters& p) { p.period_s *= 2.0; },
      [](HapticParameters& p) { p.stroke_gap_s *= 2.0; },
      [](HapticParameters& p) { p.touch_by_points = 1; },
      [](HapticParameters& p) { p.arms[0].max_force_N *= 0.5; },
      [](HapticParameters& p) { p.arms[0].map.motion_scale *= 2.0; },
      [](HapticParameters& p) { p.arms[0].map.force_scale *= 0.5; },
      [](HapticParameters& p) { p.arms[0].dynamics.apparent_mass_kg *= 2.0; },
      [](HapticParameters& p) { p.arms[0].dynamics.peak_force_N *= 0.5; },
      [](HapticParameters& p) { p.arms[0].dynamics.continuous_force_N *= 0.5; },
      [](HapticParameters& p) { p.arms[0].dynamics.thermal_s += 60.0; },
      [](HapticParameters& p) { p.arms[0].tool.made_from.length_mm += 1.0; },
      [](HapticParameters& p) { p.arms[0].tool.made_from.head_mm += 1.0; },
  };
  for (std::size_t n = 0; n < std::size(kChanges); ++n) {
    HapticParameters others = run.parameters;
    kChanges[n](others);
    EXPECT_TRUE(refused(*placed(others, moment), bytes)) << "change " << n;
  }
  EXPECT_TRUE(fresh->core.load(bytes)) << "as it was";
}

}  // namespace
}  // namespace trephine
