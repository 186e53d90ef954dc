// The state of each part of the core that rarely does what it keeps something for: one that read it
// at any tick goes on, bit for bit, as the one that wrote it.
#include "base/state_archive.h"
#include "haptics/bounded_controller.h"
#include "haptics/controllers.h"
#include "haptics/device_rules.h"
#include "haptics/hand_work.h"
#include "haptics/laws/elastic.h"
#include "haptics/proxy.h"
#include "haptics/removal.h"
#include "haptics/safety.h"
#include "strokes_support.h"

namespace trephine {
namespace {

using Outcome = std::vector<double>;

template <class Part>
std::vector<std::byte> stateOf(const Part& part) {
  StateWriter writer;
  writer(part);
  return writer.bytes();
}

template <class Part>
void read(Part& part, const std::vector<std::byte>& state) {
  StateReader reader(state);
  reader(part);
  ASSERT_TRUE(reader.ok() && reader.atEnd());
}

// `fresh()` makes a part; `step(part, input)` is a tick and says what came of it. Reads every
// `every`-th state, by turns into a fresh part and into one that was used otherwise, and runs on
// for `run_on` ticks.
template <class Make, class Input, class Step>
void expectGoesOn(Make fresh, const std::vector<Input>& inputs, Step step, std::size_t every,
                  std::size_t run_on) {
  std::vector<std::vector<std::byte>> states;
  std::vector<Outcome> outcomes;
  auto ran = fresh();
  for (const Input& input : inputs) {
    states.push_back(stateOf(ran));
    outcomes.push_back(step(ran, input));
  }
  states.push_back(stateOf(ran));
  bool used = false;
  for (std::size_t n = 0; n < inputs.size(); n += every, used = !used) {
    auto other = fresh();
    for (std::size_t m = 0; used && m < 40; ++m) {
      step(other, inputs[(n + inputs.size() / 3 + m) % inputs.size()]);
    }
    read(other, states[n]);
    const std::size_t end = std::min(inputs.size(), n + run_on);
    for (std::size_t m = n; m < end; ++m) {
      ASSERT_EQ(step(other, inputs[m]), outcomes[m]) << "tick " << m << ", read before " << n;
    }
    ASSERT_TRUE(stateOf(other) == states[end]) << "tick " << end << ", read before " << n;
  }
}

// ---- Controllers.

struct ControllerTick {
  Impedance tissue;
  ControllerInput in;
};

Outcome stepOf(BoundedController& controller, const ControllerTick& tick) {
  const Impedance limited = controller.limit(tick.tissue);
  const Vec3 force_N = controller.bound(tick.in);
  return {limited.damping,
          limited.stiffness,
          force_N.x,
          force_N.y,
          force_N.z,
          controller.credit_J(),
          controller.learntScale(),
          double(controller.parts())};
}

// A hand that presses an arm on tissue of any firmness, pulls it fast, shakes, rests and lets go;
// the arm is not as stated, and at times is sent another force than the controller's.
std::vector<ControllerTick> pressedBy(unsigned seed, const ArmDynamics& stated, double mass_kg,
                                      std::size_t delay_ticks, std::size_t count) {
  constexpr double T = 0.001;
  test::Random random(seed);
  BoundedController controller(stated, T);
  std::vector<ControllerTick> ticks;
  std::deque<Vec3> on_the_way_N(delay_ticks, Vec3(0.0));
  Vec3 at_m(0.0, 0.0, 0.01), speed_m_s(0.0), goal_m = at_m, sampled_m = at_m, sent_N(0.0);
  double stiffness = 0.0, hand = 1000.0;
  int phase_left = 0, disobeys_left = 0;
  bool shakes = false;
  while (ticks.size() < count) {
    if (--phase_left < 0) {
      const int what = random.below(6);
      phase_left = what == 0 ? 2600 : 100 + random.below(500);  // a long rest, or soon another
      goal_m =
          Vec3(random.in(-1, 1), random.in(-1, 1), what == 1 ? 5.0 : random.in(-12, 0)) * 0.001;
      stiffness = random.of({300.0, 1500.0, 8000.0, 30000.0});
      hand = random.of({150.0, 1000.0, 4000.0});
      shakes = random.below(5) == 0;
    }
    if (--disobeys_left < -300 && random.below(300) == 0) disobeys_left = 3 + random.below(40);
    on_the_way_N.push_back(sent_N);
    const Vec3 force_N = on_the_way_N.front();
    on_the_way_N.pop_front();
    const Vec3 shaking_N(0.0, 0.0, shakes ? (ticks.size() / 2 % 2 ? 3.0 : -3.0) : 0.0);
    for (int n = 0; n < 20; ++n) {
      const Vec3 hand_N = hand * (goal_m - at_m) - 6.0 * speed_m_s + shaking_N;
      speed_m_s += T / 20 / mass_kg * (hand_N + force_N);
      at_m += T / 20 * speed_m_s;
    }
    const double q = stated.encoder_step_m;
    const Vec3 sample_m = q > 0.0 ? q * glm::round(at_m / q) : at_m;
    ControllerTick tick;
    tick.tissue = {5.0, stiffness};
    const Impedance limited = controller.limit(tick.tissue);
    ControllerInput& in = tick.in;
    in.position_m = sample_m;
    in.velocity_m_s = (sample_m - sampled_m) / T;
    in.last_sent_N = sent_N;
    in.touching = sample_m.z < 0.0;
    if (in.touching) {
      in.rendered = springAndDamper(Vec3(0.0, 0.0, -limited.stiffness * sample_m.z),
                                    limited.stiffness, limited.damping);
      in.demanded_N =
          springAndDamper(Vec3(0.0, 0.0, -stiffness * sample_m.z), stiffness, tick.tissue.damping)
              .at(in.velocity_m_s);
    }
    sent_N = controller.bound(in);
    if (disobeys_left > 0) sent_N *= 0.3;
    sampled_m = sample_m;
    ticks.push_back(tick);
  }
  return ticks;
}

TEST(StatePart, ABoundedControllerGoesOnWithWhatItLearntOfHandAndArm) {
  struct Tried {
    ArmDynamics stated;
    double mass_kg;
    std::size_t delay_ticks;
  };
  const std::vector<Tried> all{{{0.045, 5.5e-5, 12.0, 0.0}, 0.045, 3},
                               {{0.045, 2e-4, 12.0, 0.0015}, 0.015, 1},
                               {{0.045, 0.0, 60.0, 0.0}, 0.045, 0},
                               {{0.2, 5.5e-6, 12.0, 0.001}, 0.2, 0}};
  std::uint32_t parts = 0;
  for (std::size_t n = 0; n < all.size(); ++n) {
    SCOPED_TRACE("arm " + std::to_string(n));
    const auto& [stated, mass_kg, delay_ticks] = all[n];
    const auto ticks = pressedBy(unsigned(n + 1), stated, mass_kg, delay_ticks, 9000);
    expectGoesOn([&] { return BoundedController(stated, 0.001); }, ticks,
                 [&](BoundedController& controller, const ControllerTick& tick) {
                   const Outcome out = stepOf(controller, tick);
                   parts |= controller.parts();
                   return out;
                 },
                 37, 700);
  }
  for (ControllerPart part : {kPartLearned, kPartCredit, kPartHold, kPartArmNotAsStated}) {
    EXPECT_TRUE(parts & part) << part;
  }
}

TEST(StatePart, ALearntScaleGoesOnFromTheValueAtWhichItFellLast) {
  std::vector<int> events;
  test::Random random(1);
  for (int n = 0; n < 20'000; ++n) events.push_back(random.below(2500) == 0 ? 0 : n % 5000 < 500);
  expectGoesOn([] { return LearntScale(); }, events,
               [](LearntScale& scale, int event) {
                 if (event == 1) scale.inAir(0.001);
                 if (event == 0) scale.inContact(0.001);
                 if (event == 0 && scale.value >= 0.99) scale.lower(0.3, 0.2);
                 return Outcome{scale.value};
               },
               61, 3000);
}

TEST(StatePart, ASeedControllerGoesOnWithTheEnergyThatItSaw) {
  test::Random random(5);
  std::vector<ControllerInput> ticks(500);
  for (ControllerInput& in : ticks) {
    in.demanded_N = Vec3(random.in(-1, 1), random.in(-1, 1), random.in(-1, 1));
    in.velocity_m_s = 0.1 * Vec3(random.in(-1, 1), random.in(-1, 1), random.in(-1, 1));
  }
  int damped = 0;
  expectGoesOn([] { return SeedController(); }, ticks,
               [&](SeedController& controller, const ControllerInput& in) {
                 const Vec3 force_N = controller.bound(in);
                 damped += controller.report().alpha > 0.0;
                 return Outcome{force_N.x, force_N.y, force_N.z, controller.report().alpha};
               },
               1, 20);
  EXPECT_GT(damped, 100);
}

// ---- Rules.

// Whether it happens in this tick: many times at a time, and hours between.
std::vector<int> bursts(unsigned seed, std::size_t count, int rarely, int often, int of) {
  test::Random random(seed);
  std::vector<int> out;
  bool burst = false;
  for (std::size_t n = 0; n < count; ++n) {
    if (random.below(1500) == 0) burst = !burst;
    out.push_back(random.below(burst ? often : rarely) ? 0 : 1 + random.below(of));
  }
  return out;
}

TEST(StatePart, LatenessGoesOnWithTheStallsBefore) {
  int kept = 0;
  expectGoesOn([] { return LatenessRule(); }, bursts(1, 20'000, 20'000, 500, 12),
               [&](LatenessRule& rule, int what) {
                 if (what == 1) rule.clear();
                 rule.tick(what > 6 ? 25'000'000 : what > 3 ? 8'000'000 : 0, what == 3, 0.01);
                 kept += rule.kept();
                 return Outcome{double(rule.away()), double(rule.kept())};
               },
               31, 4000);
  EXPECT_GT(kept, 100);
}

TEST(StatePart, ErrorsOfAnArmGoOnWithThoseBefore) {
  int kept = 0;
  expectGoesOn([] { return ErrorRule(); }, bursts(2, 20'000, 20'000, 150, 8),
               [&](ErrorRule& rule, int what) {
                 if (what == 1) rule.clear();
                 rule.tick(what > 1, 0.01);
                 kept += rule.kept();
                 return Outcome{double(rule.away()), double(rule.kept())};
               },
               31, 1500);
  EXPECT_GT(kept, 100);
  // One error that is said in two ticks is one, whoever read the state between them.
  std::vector<int> twice;
  for (int n = 0; n < 5000; ++n) twice.push_back(n % 400 < 2);
  expectGoesOn([] { return ErrorRule(); }, twice,
               [](ErrorRule& rule, int error) {
                 rule.tick(error != 0, 0.01);
                 return Outcome{double(rule.away()), double(rule.kept())};
               },
               1, 900);
}

TEST(StatePart, WarmMotorsStayAsWarmAsTheyAre) {
  ArmDynamics arm;
  arm.thermal_s = 2.0;
  arm.continuous_force_N = 0.5;
  expectGoesOn([] { return WarmthRule(); }, bursts(3, 10'000, 50, 2, 4),
               [&](WarmthRule& rule, int what) {
                 return Outcome{rule.limit_N(3.3, what > 2, 0.25 * what, arm, 0.01)};
               },
               31, 500);
}

TEST(StatePart, ALimitedForceGoesOnRisingFadingAndWaiting) {
  test::Random random(4);
  std::vector<std::array<int, 3>> ticks;
  for (int n = 0; n < 8000; ++n) {
    const int what = random.below(120);
    ticks.push_back({what < 7 ? what : 7, random.below(50) == 0, random.below(4)});
  }
  expectGoesOn([] { return OutputLimiter(); }, ticks,
               [&](OutputLimiter& limiter, const std::array<int, 3>& tick) {
                 const auto [what, late, direction] = tick;
                 if (what == 0) limiter.change();
                 if (what == 1) limiter.restored();
                 if (what == 2) limiter.rampIn();
                 if (what == 3) limiter.release();
                 if (what == 4 || what == 5) limiter.engage();
                 const Vec3 demanded_N = Vec3(direction == 0, 1.0, 2.0);
                 const Vec3 out_N = limiter.limit(demanded_N, direction > 1, what != 6,
                                                  late ? 9'000'000 : 0, 0.001);
                 return Outcome{out_N.x, out_N.y, out_N.z, double(limiter.waitingForAir())};
               },
               7, 200);
}

TEST(StatePart, TheWorkOfAHandGoesOnWhereItsSpringsBeginAnew) {
  test::Random random(5);
  std::vector<std::array<double, 3>> ticks;
  for (int n = 0; n < 3000; ++n) {
    // By turns: the springs begin anew, and no tick ends, as where a pose is none.
    const double what = random.below(60) == 0 ? 1.0 : random.below(30) == 0 ? 2.0 : 0.0;
    ticks.push_back({what, random.in(-1.0, 0.5), random.in(0.0, 2e-3)});
  }
  expectGoesOn([] { return HandWork(); }, ticks,
               [](HandWork& work, const std::array<double, 3>& tick) {
                 const auto [what, force_N, stored_J] = tick;
                 if (what == 1.0) {
                   work.forget();
                   return Outcome{work.lost_J()};
                 }
                 work.addDeviceWork(Vec3(0.0, 0.0, force_N), Vec3(0.0, 0.0, 1e-3), 1.0);
                 if (what == 2.0) return Outcome{work.lost_J()};
                 work.addModelWork(-0.8e-3 * force_N);
                 const double more_J = work.endTick(stored_J, 0.5 + force_N * 0.1, 1e-5);
                 return Outcome{more_J, work.lost_J(), work.done_J(), work.stored_J()};
               },
               1, 60);
}

// A sphere that enters soft tissue, goes about in it and leaves it.
TEST(StatePart, AnElasticLawGoesOnFromTheDepthOfItsSphereAndThePushOfAParting) {
  test::Random random(6);
  std::vector<std::pair<LawInput, ElasticLaw::Answer>> ticks;
  Vec3 tip_m(0.0);
  bool parts = false;
  double least = 0.0;
  for (int n = 0; n < 3000; ++n) {
    LawInput in;
    ElasticLaw::Answer answer;
    if (n % 100 == 0) parts = random.below(2) == 0;
    if (n % 10 == 0) least = random.below(3) ? random.in(0.0, 1.0) : 0.0;
    tip_m += 1e-4 * Vec3(random.in(-1, 1), random.in(-1, 1), random.in(-1, 1));
    in.tip_m = tip_m;
    in.share = {1.0, 1.0};
    answer.radius_m = 0.002;
    answer.parts = parts;
    if (n % 100 < 90) {  // else it is in air
      answer.push.force_N = Vec3(random.in(-0.2, 0.2), 0.1, 1.0);
      answer.push.stiffness = 300.0;
      answer.push.at_centre = n % 100 > 10 ? 1200.0 * least : 0.0;
    }
    ticks.emplace_back(in, answer);
  }
  expectGoesOn([] { return ElasticLaw(1); }, ticks,
               [](ElasticLaw& law, const auto& tick) {
                 ContactForce out;
                 law.add(tick.first, tick.second, out);
                 return Outcome{out.elastic_N.x, out.elastic_N.y, out.elastic_N.z, out.stored_J};
               },
               1, 40);
}

// ---- What moves in tissue.

struct PartField {
  PartField(double voxel_mm, const TissueTable& table)
      : grid(test::blockOf({Vec3(voxel_mm), Vec3(6.0), Vec3(0.12, -0.07, 1.0)})),
        writer(*grid.takeWriter()),
        tissue(grid, table) {}
  Grid grid;
  Grid::Writer writer;
  TissueField tissue;
};

TissueTable boneAlone(double cutting_J_per_mm3) {
  TissueTable table;
  table.count = 1;
  table.classes[0] = test::bone();
  table.classes[0].cutting_J_per_mm3 = cutting_J_per_mm3;
  return table;
}

Pose at(const Vec3& tip_mm) {
  return {tip_mm, Quat(1, 0, 0, 0)};
}

// Two removals at the same voxels, one of which read the state of the other before `tick`.
struct Sweep {
  std::vector<Vec3> way_mm;  // a tick each
  double work_J;             // a tick
};
std::vector<Outcome> sweep(const Tool& tool, double voxel_mm, const Sweep& sweep,
                           std::size_t other_from) {
  PartField field(voxel_mm, boneAlone(0.01));
  const Removal fresh(tool, field.grid.geometry(), RemovalKind::work, 0.001);
  Removal removal = fresh;
  std::vector<Outcome> out;
  std::vector<RemovedVoxel> removed;
  removed.reserve(Removal::kMostVoxels);
  for (std::size_t n = 0; n < sweep.way_mm.size(); ++n) {
    if (n == other_from) {
      const std::vector<std::byte> state = stateOf(removal);
      removal = fresh;
      read(removal, state);
    }
    removal.giveWork(sweep.work_J, 1e9, field.tissue);
    removed.clear();
    removal.sweep(field.tissue, at(sweep.way_mm[n]), removed);
    out.push_back({double(removed.size()), removal.credit_J()});
    for (const RemovedVoxel& voxel : removed) {
      const auto& [i, j, k] = voxel.voxel;
      const std::size_t index = field.grid.geometry().indexOf(i, j, k);
      field.writer.store(index, kAirHu);
      field.tissue.removed(voxel.voxel, voxel.tissue_class);
      out.back().push_back(double(index));
    }
  }
  return out;
}

TEST(StatePart, ARemovalGoesOnInTheRowAtWhichItWasAndForgetsAfterAJump) {
  const Tool burr = test::tool(ToolKind::burr, 30.0, 3.0, 4.0);
  Sweep passes{{}, 1.0};  // on a fine grid a pass takes many ticks
  for (int n = 0; n < 24; ++n) passes.way_mm.push_back({-1.0 + 0.05 * n, 0.0, -2.0 - 0.03 * n});
  Sweep jumps{{}, 1.0};
  for (int n = 0; n < 75; ++n) {
    jumps.way_mm.push_back({n / 30 % 2 ? 4.0 : -4.0, 0.0, n / 30 % 2 ? -3.0 : -2.5});
  }
  for (const auto& [way, voxel_mm] : {std::pair{&passes, 0.2}, {&jumps, 1.0}}) {
    const std::vector<Outcome> alone = sweep(burr, voxel_mm, *way, 1'000'000);
    for (std::size_t n = 1; n < alone.size(); ++n) {
      EXPECT_EQ(sweep(burr, voxel_mm, *way, n), alone) << "read before " << n;
    }
  }
}

// Followed in a tick by its arm: along a surface, and away from it faster than it can follow.
TEST(StatePart, AProxyGoesOnPullingBetweenTheTissueThatHeldItAndItsArm) {
  std::vector<Pose> way;
  test::Random random(7);
  Vec3 arm_mm(0.0, 0.0, 4.0), goal_mm = arm_mm, lean(0.0), goal_lean(0.0);
  for (int n = 0; n < 270; ++n) {
    if (n % 40 == 0) {
      goal_mm = {random.in(-4, 4), random.in(-4, 4), random.in(-3, 0.5)};
      goal_lean = {random.in(-0.6, 0.6), random.in(-0.6, 0.6), 0.0};
    }
    arm_mm += 0.1 * (goal_mm - arm_mm);
    lean += 0.05 * (goal_lean - lean);
    const bool away = n % 90 > 84;
    way.push_back({away ? Vec3(arm_mm.x, arm_mm.y, 13.0) : arm_mm, test::turned(lean)});
  }
  for (const auto& [shape, voxel_mm] :
       {std::pair{BurrShape::sphere, 0.5}, {BurrShape::cylinder, 0.25}}) {
    PartField field(voxel_mm, boneAlone(0.01));
    const Tool burr = test::tool(ToolKind::burr, 30.0, 2.5, 0.0, shape);
    const VoxelBounds everywhere{{0, 0, 0}, {999, 999, 999}};
    int lags = 0;
    expectGoesOn([&] { return Proxy(burr, field.grid.geometry()); }, way,
                 [&](Proxy& proxy, const Pose& arm) {
                   proxy.follow(field.tissue, arm, Cutting::nothing);
                   // Of what it has, all is still there.
                   if (arm.position.x > 2.0) proxy.removed(field.tissue, {}, everywhere);
                   const Pose pose = proxy.pose_mm();
                   const Pull pull = proxy.pull();
                   lags += proxy.held() && arm.position.z > 12.0;
                   return Outcome{pose.position.x,    pose.position.y,    pose.position.z,
                                  pose.orientation.w, pose.orientation.x, pose.orientation.y,
                                  pull.shift_mm.z,    pull.stiffness,     double(proxy.heldBy())};
                 },
                 1, 12);
    EXPECT_GT(lags, 5);
  }
}

}  // namespace
}  // namespace trephine
