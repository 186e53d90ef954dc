#include "haptics/bounded_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <random>
#include <vector>

#include "haptics/controllers.h"
#include "haptics/safety.h"

namespace trephine {
namespace {

constexpr double kT = 0.001;
constexpr double kOmniStep_m = 0.055e-3;

ArmDynamics arm(double mass_kg, double encoder_m, int delay = 0) {
  ArmDynamics dynamics;
  dynamics.apparent_mass_kg = mass_kg;
  dynamics.encoder_step_m = encoder_m;
  dynamics.delay_ticks = delay;
  return dynamics;
}

// What an encoder of this step cannot see, as the bars of the stability grid have it.
double unseen_J(const ArmDynamics& dynamics) {
  return std::max(0.05e-3, 1.0 * dynamics.encoder_step_m);
}

// Numbers that are the same with every standard library.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : random_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * (double(random_()) / 4294967296.0);
  }
  double decadesBetween(double low, double high) {
    return low * std::pow(high / low, between(0.0, 1.0));
  }
  Vec3 vector(double size) {
    const double x = between(-size, size), y = between(-size, size);
    return {x, y, between(-size, size)};
  }

 private:
  std::mt19937 random_;
};

// A tissue that fills x < 0, touched through a controller by whatever position is given.
struct Touch {
  BoundedController controller;
  Impedance tissue;
  double period_s;
  double last_m = 0.0;
  bool started = false;
  Vec3 sent_N{0.0};
  double demanded_N = 0.0;

  Touch(const ArmDynamics& dynamics, const Impedance& of_tissue, double T = kT)
      : controller(dynamics, T), tissue(of_tissue), period_s(T) {}

  double at(double x) {
    ControllerInput in;
    in.period_s = period_s;
    in.touching = x < 0.0;
    in.position_m.x = x;
    in.velocity_m_s.x = started ? (x - last_m) / period_s : 0.0;
    in.last_sent_N = sent_N;
    started = true;
    last_m = x;
    const Impedance allowed = controller.limit(in.touching ? tissue : Impedance{});
    if (in.touching) {
      in.demanded_N.x = -tissue.stiffness * x - tissue.damping * in.velocity_m_s.x;
      in.rendered = springAndDamper({-allowed.stiffness * x, 0.0, 0.0}, allowed.stiffness, allowed.damping);
    }
    demanded_N = in.demanded_N.x;
    sent_N = controller.bound(in);
    return sent_N.x;
  }
};

// An arm that nobody holds but a constant push, moved exactly by the forces that reach it.
struct SimulatedArm {
  double mass_kg;
  double period_s;
  double encoder_m;
  std::deque<double> on_the_way;
  double x = 0.002;
  double v = 0.0;
  double push_N = 0.0;
  double friction_N_s_m = 0.05;
  double given_J = 0.0;       // by the environment, net
  double most_given_J = 0.0;

  SimulatedArm(const ArmDynamics& dynamics, double T)
      : mass_kg(dynamics.apparent_mass_kg),
        period_s(T),
        encoder_m(dynamics.encoder_step_m),
        on_the_way(std::size_t(dynamics.delay_ticks), 0.0) {}

  void tick(Touch& touch) {
    on_the_way.push_back(touch.at(encoder_m > 0.0 ? std::round(x / encoder_m) * encoder_m : x));
    const double force_N = on_the_way.front();
    on_the_way.pop_front();
    constexpr int kParts = 8;
    const double h = period_s / kParts;
    for (int i = 0; i < kParts; ++i) {
      const double a = (force_N + push_N - friction_N_s_m * v) / mass_kg;
      const double moved = h * v + 0.5 * h * h * a;
      x += moved;
      v += h * a;
      given_J += force_N * moved;
      most_given_J = std::max(most_given_J, given_J);
    }
  }
};

TEST(BoundedController, SendsNoForceInAir) {
  Numbers numbers(1);
  BoundedController controller(arm(0.045, kOmniStep_m, 1), kT);
  Vec3 position_m(0.0);
  for (int i = 0; i < 2000; ++i) {
    position_m += numbers.vector(1e-3);
    controller.limit({});
    ControllerInput in;
    in.position_m = position_m;
    in.velocity_m_s = numbers.vector(1.0);
    in.demanded_N = numbers.vector(3.0);  // whatever the laws say
    in.rendered = springAndDamper(numbers.vector(3.0), 500.0, 5.0);
    ASSERT_EQ(controller.bound(in), Vec3(0.0));
  }
  EXPECT_EQ(controller.parts(), 0u);
}

TEST(BoundedController, LetsGoAtOnceWhenTheTipIsOut) {
  Touch touch(arm(0.045, 0.0), {1.0, 500.0});
  for (int i = 0; i < 200; ++i) touch.at(-0.02e-3 * i);
  ASSERT_GT(touch.sent_N.x, 1.0);
  EXPECT_EQ(touch.at(1e-6), 0.0) << "even with credit left";
}

TEST(BoundedController, PassesASoftTissueOnAFineEncoderNearlyUnchanged) {
  for (const Impedance& tissue :
       {Impedance{0.5, 300.0}, Impedance{2.0, 200.0}, Impedance{5.0, 0.0}}) {
    Touch touch(arm(0.045, 1e-6), tissue);
    const double v = 0.02;
    double worst = 0.0;
    for (int i = 0; i < 400; ++i) {
      const double x = 0.5e-3 - v * i * kT;
      touch.at(std::round(x / 1e-6) * 1e-6);
      if (x < -0.5e-3) {
        const double ideal_N = -tissue.stiffness * x + tissue.damping * v;
        worst = std::max(worst, std::abs(touch.sent_N.x - ideal_N) / ideal_N);
        // What differs is the noise of the backward difference, and is said to be that.
        ASSERT_EQ(touch.controller.parts() & ~(kPartEstimate | kPartPrediction), 0u) << "at " << x;
        ASSERT_EQ(touch.controller.parts() == 0, touch.sent_N.x == touch.demanded_N) << "at " << x;
      }
    }
    EXPECT_LT(worst, 0.04) << "b " << tissue.damping << ", k " << tissue.stiffness;
    EXPECT_EQ(touch.controller.learntScale(), 1.0);
  }
}

TEST(BoundedController, SaysThatATissueIsFirmerThanTheArmRenders) {
  BoundedController controller(arm(0.045, kOmniStep_m), kT);
  controller.limit({1e9, 0.0});
  EXPECT_EQ(controller.parts(), std::uint32_t(kPartArmBound));
  controller.limit({0.0, 1e9});
  EXPECT_EQ(controller.parts(), std::uint32_t(kPartArmBound));
  controller.limit({1e9, 1e9});
  EXPECT_EQ(controller.parts(), std::uint32_t(kPartArmBound));
  const Impedance soft = controller.limit({1.0, 200.0});
  EXPECT_EQ(controller.parts(), 0u);
  EXPECT_EQ(soft.damping, 1.0);
  EXPECT_EQ(soft.stiffness, 200.0);
  controller.limit({});
  EXPECT_EQ(controller.parts(), 0u) << "air";
}

TEST(BoundedController, LetsNoMoreBeRenderedThanTheArmRendersOnceAContactLasts) {
  Numbers numbers(2);
  for (int i = 0; i < 200; ++i) {
    const double step = i % 3 == 0 ? 0.0 : numbers.decadesBetween(1e-6, 1e-3);
    const ArmDynamics dynamics =
        arm(numbers.decadesBetween(0.005, 0.5), step, i % (kMaxDelayTicks + 1));
    const double rate_hz = numbers.decadesBetween(250.0, 8000.0);
    const Renderable most = renderable(dynamics, rate_hz, dynamics.delay_ticks, {});
    ASSERT_GT(most.b_max, 0.0);
    ASSERT_GT(most.k_max, 0.0);
    const Impedance below{0.9 * most.b_max, 0.9 * most.k_max};
    const Impedance above{1.1 * most.b_max, 1.1 * most.k_max};
    const Impedance rock{1e9, 1e9};

    Touch touch(dynamics, rock, 1.0 / rate_hz);
    EXPECT_EQ(touch.controller.limit(below).stiffness, below.stiffness);
    EXPECT_EQ(touch.controller.limit(below).damping, below.damping);
    EXPECT_DOUBLE_EQ(touch.controller.limit(above).damping, most.b_max);
    EXPECT_DOUBLE_EQ(touch.controller.limit(rock).damping, most.b_max);
    // A wall may be firmer while it is struck, and no longer.
    for (int n = 0; n < int(0.2 * rate_hz); ++n) touch.at(-0.1e-3);
    for (const Impedance& tissue : {below, above, rock, Impedance{1e9, 0.0}, Impedance{0.0, 1e9}}) {
      const Impedance limited = touch.controller.limit(tissue);
      ASSERT_LE(limited.damping, std::min(tissue.damping, most.b_max) * (1.0 + 1e-9));
      ASSERT_LE(limited.stiffness, std::min(tissue.stiffness, most.k_max) * (1.0 + 1e-9));
    }
  }
}

TEST(Renderable, FallsWithDelayAndPeriodAndRisesWithMass) {
  for (double mass : {0.02, 0.045, 0.2}) {
    for (double rate_hz : {500.0, 1000.0, 4000.0}) {
      for (int delay : {0, 1, 3, 15}) {
        for (double step : {0.0, kOmniStep_m, 0.2e-3}) {
          const Renderable here = renderable(arm(mass, step), rate_hz, delay, {});
          const Renderable later = renderable(arm(mass, step), rate_hz, delay + 1, {});
          const Renderable slower = renderable(arm(mass, step), rate_hz / 2.0, delay, {});
          const Renderable heavier = renderable(arm(2.0 * mass, step), rate_hz, delay, {});
          EXPECT_LT(later.b_max, here.b_max);
          EXPECT_LT(slower.b_max, here.b_max);
          EXPECT_GT(heavier.b_max, here.b_max);
          // A count of a coarse encoder may be what bounds k, whatever the rest.
          EXPECT_LE(later.k_max, here.k_max);
          EXPECT_LE(slower.k_max, here.k_max);
          EXPECT_GE(heavier.k_max, here.k_max);
          if (step == 0.0) {
            EXPECT_LT(later.k_max, here.k_max);
            EXPECT_LT(slower.k_max, here.k_max);
            EXPECT_GT(heavier.k_max, here.k_max);
          } else {
            EXPECT_LT(here.k_max, renderable(arm(mass, 0.0), rate_hz, delay, {}).k_max);
          }
        }
      }
    }
  }
}

TEST(Renderable, IsBoundByTheCountsOfTheEncoderWhereTheArmIsHeavy) {
  for (double step : {kOmniStep_m, 0.2e-3}) {
    const double heavy = renderable(arm(2.0, step), 4000.0, 0, {}).k_max;
    EXPECT_EQ(heavy, renderable(arm(4.0, step), 4000.0, 0, {}).k_max);
    EXPECT_LT(heavy * step, 1.0) << "one count must not change the force by a newton";
    EXPECT_DOUBLE_EQ(renderable(arm(2.0, 2.0 * step), 4000.0, 0, {}).k_max, heavy / 2.0);
  }
}

TEST(Renderable, TakesItsDelayFromTheArgument) {
  const double none = renderable(arm(0.045, 0.0, 5), 1000.0, 0, {}).k_max;
  EXPECT_EQ(none, renderable(arm(0.045, 0.0), 1000.0, 0, {}).k_max);
  EXPECT_GT(none, renderable(arm(0.045, 0.0), 1000.0, kMaxDelayTicks, {}).k_max);
}

TEST(Renderable, IsInThePatientsMetresAndNewtons) {
  WorkspaceMap map;
  map.motion_scale = 3.0;
  map.force_scale = 0.25;
  const Renderable at_arm = renderable(arm(0.045, kOmniStep_m), 1000.0, 1, {});
  const Renderable in_patient = renderable(arm(0.045, kOmniStep_m), 1000.0, 1, map);
  // A tissue's b and k are g s b and g s k at the arm.
  EXPECT_DOUBLE_EQ(3.0 * 0.25 * in_patient.b_max, at_arm.b_max);
  EXPECT_DOUBLE_EQ(3.0 * 0.25 * in_patient.k_max, at_arm.k_max);
}

TEST(BoundedController, NeverExceedsThePeakAndStaysFiniteWhateverThePose) {
  Numbers numbers(3);
  for (int run = 0; run < 60; ++run) {
    ArmDynamics dynamics = arm(numbers.decadesBetween(0.005, 0.5), run % 2 == 0 ? 0.0 : kOmniStep_m,
                               run % (kMaxDelayTicks + 1));
    dynamics.peak_force_N = numbers.between(0.5, 10.0);
    BoundedController controller(dynamics, kT);
    Vec3 position_m(0.0), last_m(0.0), sent_N(0.0);
    for (int i = 0; i < 400; ++i) {
      const double kind = numbers.between(0.0, 1.0);
      if (kind < 0.05) position_m = numbers.vector(1e6);
      else if (kind < 0.1) position_m = numbers.vector(1e-3);
      else if (kind < 0.4) position_m += numbers.vector(1e-310);
      else position_m += numbers.vector(1e-3);
      const bool touching = numbers.between(0.0, 1.0) < 0.8;
      const double b = numbers.between(0.0, 1.0) < 0.2 ? 1e9 : numbers.between(0.0, 50.0);
      const double k = numbers.between(0.0, 1.0) < 0.3 ? 0.0 : numbers.decadesBetween(1.0, 1e9);
      const Impedance allowed = controller.limit(touching ? Impedance{b, k} : Impedance{});
      ControllerInput in;
      in.position_m = position_m;
      in.velocity_m_s = (position_m - last_m) / kT;
      in.last_sent_N = sent_N;
      in.touching = touching;
      if (touching) {
        in.rendered = springAndDamper(-allowed.stiffness * position_m, allowed.stiffness, allowed.damping);
        in.demanded_N = -k * position_m - b * in.velocity_m_s;
      }
      last_m = position_m;
      sent_N = controller.bound(in);
      ASSERT_TRUE(isFinite(sent_N)) << "run " << run << " tick " << i;
      ASSERT_LE(glm::length(sent_N), dynamics.peak_force_N * (1.0 + 1e-12));
      ASSERT_TRUE(isFinite(controller.credit_J()));
      ASSERT_GT(controller.learntScale(), 0.0);
      ASSERT_LE(controller.learntScale(), 1.0);
    }
  }
}

TEST(BoundedController, FeelsATissueAgainSoonAfterAJumpOfAMillionMetres) {
  for (const double away_m : {1e6, -1e6}) {
    Touch touch(arm(0.045, kOmniStep_m), {1.0, 400.0});
    for (int i = 0; i < 100; ++i) touch.at(-0.03e-3 * i);
    touch.at(away_m);
    for (int i = 0; i < 5000; ++i) touch.at(0.01);
    for (int push = 0; push < 2; ++push) {
      for (int i = 0; i < 400; ++i) touch.at(-0.01e-3 * i);
      EXPECT_GT(touch.sent_N.x, 0.5 * touch.demanded_N) << "a jump to " << away_m << " m";
      for (int i = 400; i > 200; --i) touch.at(-0.01e-3 * i);
      if (push == 1) {
        EXPECT_GT(touch.sent_N.x, 0.3 * touch.demanded_N) << "and on the way back";
      }
      for (int i = 200; i > -50; --i) touch.at(-0.01e-3 * i);
    }
  }
}

TEST(BoundedController, IsTheSameInEveryDirection) {
  using Turn = Vec3 (*)(const Vec3&);
  const Turn turns[] = {[](const Vec3& p) { return Vec3(-p.y, p.x, p.z); },
                        [](const Vec3& p) { return Vec3(p.x, -p.z, p.y); },
                        [](const Vec3& p) { return Vec3(p.z, p.x, p.y); }};
  for (Turn turn : turns) {
    for (int delay : {0, 2}) {
      Numbers numbers(4);
      BoundedController straight(arm(0.045, 1e-5, delay), kT), turned(arm(0.045, 1e-5, delay), kT);
      Vec3 position_m(0.0), velocity(0.0), sent_N(0.0);
      double forces = 0.0;
      for (int i = 0; i < 1500; ++i) {
        velocity += numbers.vector(0.004) - 0.01 * velocity - 0.05 * position_m;
        position_m += kT * velocity;
        ControllerInput in;
        const Vec3 noise_m = numbers.vector(i < 700 ? 0.0 : 1e-4);
        in.touching = position_m.x + 0.5 * position_m.y < 0.0;
        in.position_m = position_m + noise_m;
        in.velocity_m_s = velocity;
        in.last_sent_N = sent_N;
        const Impedance tissue = in.touching ? Impedance{3.0, 900.0} : Impedance{};
        const Impedance allowed = straight.limit(tissue), same = turned.limit(tissue);
        ASSERT_NEAR(allowed.stiffness, same.stiffness, 1e-9);
        ASSERT_NEAR(allowed.damping, same.damping, 1e-9);
        if (in.touching) {
          const Vec3 normal(0.8944271909999159, 0.4472135954999579, 0.0);
          in.rendered = springAndDamper(-allowed.stiffness * glm::dot(in.position_m, normal) * normal,
                         allowed.stiffness, allowed.damping);
          in.demanded_N = in.rendered.at(velocity);
        }
        ControllerInput as_turned = in;
        as_turned.position_m = turn(in.position_m);
        as_turned.velocity_m_s = turn(in.velocity_m_s);
        as_turned.last_sent_N = turn(in.last_sent_N);
        as_turned.demanded_N = turn(in.demanded_N);
        as_turned.rendered.elastic_N = turn(in.rendered.elastic_N);
        sent_N = straight.bound(in);
        const Vec3 expected_N = turn(sent_N), found_N = turned.bound(as_turned);
        for (int axis = 0; axis < 3; ++axis) {
          ASSERT_NEAR(found_N[axis], expected_N[axis], 1e-9) << "tick " << i << " axis " << axis;
        }
        ASSERT_EQ(straight.parts(), turned.parts());
        forces += glm::length(sent_N);
      }
      EXPECT_GT(forces, 10.0) << "there was something to compare";
      EXPECT_LT(straight.learntScale(), 1.0) << "and to learn";
      EXPECT_DOUBLE_EQ(straight.learntScale(), turned.learntScale());
    }
  }
}

TEST(BoundedController, HoardsNoCreditInMinutesOfCutting) {
  for (const Impedance& tissue : {Impedance{5.0, 0.0}, Impedance{5.0, 300.0}}) {
    Touch touch(arm(0.045, kOmniStep_m), tissue);
    double x = 0.0, dissipated_J = 0.0, most_J = 0.0;
    for (int i = 0; i < 60000; ++i) {
      const double moved = 0.1e-3 * std::cos(0.02 * i);  // 0.1 m/s and 5 mm about 6 mm deep
      dissipated_J += touch.tissue.damping * moved * moved / kT;
      x += moved;
      touch.at(x - 0.006);
      most_J = std::max(most_J, touch.controller.credit_J());
    }
    EXPECT_GT(dissipated_J, 1.0);
    EXPECT_GT(most_J, 0.0);
    // No more than a bounded spare beside what the spring holds at its deepest.
    EXPECT_LT(most_J, 0.5 * tissue.stiffness * 0.012 * 0.012 + 5e-3) << "k " << tissue.stiffness;
  }
}

TEST(BoundedController, DoesNotPullAnArmBackThatLeavesASpring) {
  for (int delay : {0, 1, 3}) {
    for (double acceleration : {1.0, 10.0, 50.0}) {
      Touch touch(arm(0.045, 0.0, delay), {0.0, 500.0});
      for (int i = 0; i < 300; ++i) touch.at(-0.01e-3 * i);
      for (int i = 0; touch.last_m < 0.0; ++i) {
        touch.at(-0.003 + 0.5 * acceleration * (i * kT) * (i * kT));
        ASSERT_GT(touch.sent_N.x, -0.2) << "at " << touch.last_m << " m, " << acceleration
                                        << " m/s2, delay " << delay;
      }
    }
  }
}

TEST(BoundedController, TakesWhatTheSpringHoldsForPutInWhereItBeginsInContact) {
  Touch touch(arm(0.045, 0.0), {0.5, 500.0});
  for (int i = 0; i < 300; ++i) touch.at(-0.01e-3 * i);
  touch.controller.forget();
  EXPECT_EQ(touch.controller.credit_J(), 0.0);
  touch.sent_N = Vec3(0.0);  // the core sends nothing in the tick of a resume
  touch.at(-0.003);
  EXPECT_NEAR(touch.controller.credit_J(), 0.5 * 500.0 * 0.003 * 0.003, 1e-9);
  EXPECT_NEAR(touch.sent_N.x, 1.5, 0.1)
      << "the force is there at once: the limiter lets it in slowly";
}

// An arm under a hand, with the limiter that stands behind the controller in the core.
struct GatedArm {
  Controller controller;
  OutputLimiter limiter;
  double mass_kg = 0.045, x = 0.002, v = 0.0, last_m = 0.002;
  double encoder_m, demanded_N = 0.0;
  bool open = true;
  Impedance hand{3.0, 600.0};

  GatedArm(ControllerKind kind, double step_m)
      : controller(makeController(kind, arm(0.045, step_m, 1), kT)), encoder_m(step_m) {}

  double tick() {
    const double sample = encoder_m > 0.0 ? std::round(x / encoder_m) * encoder_m : x;
    ControllerInput in;
    in.touching = sample < 0.0;
    in.position_m.x = sample;
    in.velocity_m_s.x = (sample - last_m) / kT;
    in.last_sent_N = limiter.sent_N();
    last_m = sample;
    const Impedance tissue = in.touching ? Impedance{2.0, 650.0} : Impedance{};
    const Impedance allowed = limitImpedance(controller, tissue);
    in.demanded_N.x = -tissue.stiffness * sample - tissue.damping * in.velocity_m_s.x;
    in.rendered = springAndDamper({-allowed.stiffness * sample, 0.0, 0.0}, allowed.stiffness,
                                  allowed.damping);
    demanded_N = in.demanded_N.x;
    const Vec3 before_N = limiter.sent_N();
    const Vec3 bounded_N = clampForce(boundForce(controller, in), 3.3);
    const double sent_N = limiter.limit(bounded_N, in.touching, open, 0, kT).x;
    for (int i = 0; i < 20; ++i) {  // the arm takes a force a sample late
      const double pull = -hand.stiffness * (x + 0.004) - hand.damping * v;
      v += kT / 20 * (before_N.x + pull) / mass_kg;
      x += kT / 20 * v;
    }
    return sent_N;
  }
};

void expectForceBackSoon(GatedArm& held, const char* after) {
  double before_N = held.limiter.sent_N().x, last_step_N = 0.0;
  int alternations = 0;
  for (int i = 0; i < 2000; ++i) {
    const double sent_N = held.tick(), step_N = sent_N - before_N;
    EXPECT_LE(step_N, i < 100 ? 0.05 + 1e-9 : 0.1) << after << ", " << i;
    alternations += step_N * last_step_N < -0.05 * 0.05;
    before_N = sent_N;
    last_step_N = step_N;
    if (i == 500) {
      EXPECT_GT(held.demanded_N, 0.5) << "it is pressed";
      EXPECT_GE(sent_N, 0.8 * held.demanded_N) << after;
    }
  }
  EXPECT_LE(alternations, 1) << after;  // it may turn once
}

TEST(BoundedController, GivesTheForceBackSoonAfterAResumeAndAfterASwitchInsideATissue) {
  for (const double step_m : {0.0, kOmniStep_m}) {
    GatedArm resumed(ControllerKind::bounded, step_m);
    for (int i = 0; i < 1000; ++i) resumed.tick();
    resumed.open = false;
    for (int i = 0; i < 1000; ++i) resumed.tick();
    resumed.open = true;
    forgetController(resumed.controller);
    resumed.limiter.change();
    expectForceBackSoon(resumed, "a resume");

    GatedArm switched(ControllerKind::off, step_m);
    for (int i = 0; i < 2000; ++i) switched.tick();
    switched.controller = makeController(ControllerKind::bounded, arm(0.045, step_m, 1), kT);
    switched.limiter.change();
    expectForceBackSoon(switched, "a switch");
  }
}

TEST(BoundedController, FlagsEveryDifferenceAndReturnsTheDemandedForceWhereThereIsNone) {
  Numbers numbers(7);
  std::uint32_t seen = 0;
  for (int run = 0; run < 30; ++run) {
    Touch touch(arm(numbers.decadesBetween(0.02, 0.2), run % 2 == 0 ? 0.0 : kOmniStep_m, run % 4),
                {numbers.between(0.0, 20.0), run % 3 == 0 ? 0.0 : numbers.decadesBetween(50.0, 1e5)});
    for (int i = 0; i < 1500; ++i) {
      const double x = -0.002 * std::sin(0.004 * i) + (i > 900 ? numbers.between(-1e-4, 1e-4) : 0.0);
      touch.at(run % 2 == 0 ? x : std::round(x / kOmniStep_m) * kOmniStep_m);
      const std::uint32_t parts = touch.controller.parts();
      if (touch.sent_N.x != touch.demanded_N) {
        ASSERT_NE(parts & ~std::uint32_t(kPartArmNotAsStated), 0u) << "run " << run << " tick " << i;
      }
      seen |= parts;
    }
  }
  EXPECT_TRUE(seen & kPartEstimate);
  EXPECT_TRUE(seen & kPartPrediction);
  EXPECT_TRUE(seen & kPartArmBound);

  // At rest on exact samples and without a delay nothing differs.
  Touch resting(arm(0.045, 0.0), {1.0, 300.0});
  for (int i = 0; i < 3000; ++i) resting.at(i < 100 ? -0.02e-3 * i : -0.002);
  EXPECT_EQ(resting.sent_N.x, resting.demanded_N);
  EXPECT_EQ(resting.controller.parts(), 0u);
}

TEST(BoundedController, HoldsTheForceOfAToolThatRestsBetweenTwoCounts) {
  Touch touch(arm(0.045, kOmniStep_m), {1.0, 600.0});
  for (int i = 0; i < 40; ++i) touch.at(-kOmniStep_m * i);
  double low_N = 1e9, high_N = -1e9;
  for (int i = 0; i < 1000; ++i) {
    touch.at(-kOmniStep_m * (39 + (i / 7) % 2));  // to and fro between neighbouring counts
    if (i < 500) continue;
    low_N = std::min(low_N, touch.sent_N.x);
    high_N = std::max(high_N, touch.sent_N.x);
    ASSERT_TRUE(touch.controller.parts() & kPartHold);
  }
  EXPECT_EQ(low_N, high_N);
  EXPECT_NEAR(low_N, 600.0 * 39.5 * kOmniStep_m, 0.05);
  for (int i = 0; i < 320; ++i) touch.at(-kOmniStep_m * (42 + i / 4));
  EXPECT_FALSE(touch.controller.parts() & kPartHold) << "it left";
}

TEST(BoundedController, HoldsNoForceAcrossAChangeOfTheTissueUnderAToolAtRest) {
  Touch touch(arm(0.045, kOmniStep_m), {1.0, 600.0});
  for (int i = 0; i < 40; ++i) touch.at(-kOmniStep_m * i);
  for (int i = 0; i < 1000; ++i) touch.at(-kOmniStep_m * 39);
  const double before_N = touch.sent_N.x;
  ASSERT_TRUE(touch.controller.parts() & kPartHold);
  touch.tissue.stiffness = 300.0;
  for (int i = 0; i < 1000; ++i) touch.at(-kOmniStep_m * 39);
  EXPECT_NEAR(touch.sent_N.x, 0.5 * before_N, 0.05);
}

// A tool is turned while its arm stays: the spring that held it at 1 N comes to pull at 2 N.
struct Turned {
  double least_N = 1e9, alpha = 0.0;

  explicit Turned(bool told) {
    constexpr double kK_N_per_m = 300.0;
    BoundedController controller(arm(0.045, kOmniStep_m), kT);
    ControllerInput in;
    in.touching = true;
    double last_N = 0.0;
    for (int i = 0; i < 2000; ++i) {
      // Pressed by 3.3 mm in a second, then turned for another.
      const double pressed_m = std::min(1.0, 0.001 * i) / kK_N_per_m;
      const double pull_N = kK_N_per_m * pressed_m + std::max(0.0, 0.001 * i - 1.0);
      in.velocity_m_s.x = (-pressed_m - in.position_m.x) / kT;
      in.position_m.x = -pressed_m;
      in.rotation_work_J =
          i > 1000 && told ? (pull_N * pull_N - last_N * last_N) / (2.0 * kK_N_per_m) : 0.0;
      const Impedance allowed = controller.limit({0.0, kK_N_per_m});
      in.demanded_N.x = pull_N;
      in.rendered = springAndDamper(in.demanded_N * (allowed.stiffness / kK_N_per_m), allowed.stiffness, 0.0);
      in.last_sent_N = controller.bound(in);
      if (i > 1100) least_N = std::min(least_N, in.last_sent_N.x);
      alpha = controller.learntScale();
      last_N = pull_N;
    }
  }
};

TEST(BoundedController, ShowsTheForceOfASpringThatWasStretchedByTurningTheTool) {
  const Turned told(true);
  EXPECT_GT(told.least_N, 1.0);
  EXPECT_EQ(told.alpha, 1.0);
  // Or it would be energy that nobody put in: held back, and taken for an arm that shakes.
  const Turned not_told(false);
  EXPECT_TRUE(not_told.least_N < 0.9 || not_told.alpha < 0.5);
}

// A light arm in a firm damper, and a hand that rests inside it.
struct HeldArm {
  Touch touch;
  SimulatedArm simulated;
  std::uint32_t parts_seen = 0;

  explicit HeldArm(double told_kg, double true_kg = 0.02)
      : touch(arm(told_kg, kOmniStep_m), {1e4, 0.0}), simulated(arm(true_kg, kOmniStep_m), kT) {}

  // The mean change of the force in a tick.
  double hold(int ticks) {
    double steps_N = 0.0;
    for (int i = 0; i < ticks; ++i) {
      const double before_N = touch.sent_N.x;
      simulated.push_N = -300.0 * (simulated.x + 0.004) - 2.0 * simulated.v;
      simulated.tick(touch);
      steps_N += std::abs(touch.sent_N.x - before_N);
      parts_seen |= touch.controller.parts();
    }
    return steps_N / ticks;
  }
  void inAir(int ticks) {
    for (int i = 0; i < ticks; ++i) touch.at(0.01);
  }
};

TEST(BoundedController, RendersLessOnceAHandShakesAndMoreAgainAfterTimeInAir) {
  HeldArm shaking(0.02);
  EXPECT_EQ(shaking.touch.controller.learntScale(), 1.0);
  shaking.hold(1500);
  const double learnt = shaking.touch.controller.learntScale();
  EXPECT_LT(learnt, 0.9);
  EXPECT_TRUE(shaking.parts_seen & kPartLearned);
  EXPECT_LT(shaking.touch.controller.limit({1e9, 0.0}).damping,
            renderable(arm(0.02, kOmniStep_m), 1000.0, 0, {}).b_max);

  shaking.inAir(300);
  const double later = shaking.touch.controller.learntScale();
  EXPECT_GT(later, learnt);
  shaking.inAir(20000);
  EXPECT_EQ(shaking.touch.controller.learntScale(), 1.0);
}

TEST(BoundedController, CalmsAnArmThatIsLighterThanItWasTold) {
  HeldArm shaking(0.03);
  double shaken_N = 0.0;
  for (int i = 0; i < 8; ++i) shaken_N = std::max(shaken_N, shaking.hold(50));
  EXPECT_GT(shaken_N, 0.1) << "it did shake";
  shaking.hold(2000);
  EXPECT_LT(shaking.hold(400), 0.1) << "the bar of the stability grid";
}

TEST(LearntScale, ComesBackInContactToJustBelowWhereSomethingHappened) {
  LearntScale scale;
  for (int i = 0; i < 40; ++i) {  // one event: down and down within a moment
    scale.lower(0.9, 0.2);
    scale.inContact(0.001);
  }
  ASSERT_LE(scale.value, 0.2);
  for (int i = 0; i < 1000; ++i) scale.inContact(0.001);
  EXPECT_LE(scale.value, 0.2) << "not until it has been quiet for a while";
  for (int i = 0; i < 1000; ++i) scale.inContact(0.001);
  EXPECT_GE(scale.value, 0.9) << "0.9 of what was stable, after 2 s";
  EXPECT_LT(scale.value, 0.96) << "and then slowly";
  const double before = scale.value;
  scale.lower(0.9, 0.2);
  for (int i = 0; i < 3000; ++i) scale.inContact(0.001);
  EXPECT_LT(scale.value, 0.95 * before) << "it stays below where the same happened again";
}

TEST(BoundedController, RemembersWhatItLearntAfterAnUndo) {
  HeldArm shaking(0.02);
  shaking.hold(1500);
  const double learnt = shaking.touch.controller.learntScale();
  ASSERT_LT(learnt, 1.0);
  shaking.touch.controller.forget();
  EXPECT_EQ(shaking.touch.controller.learntScale(), learnt);
  EXPECT_EQ(shaking.touch.controller.credit_J(), 0.0);
}

TEST(BoundedController, GivesABounceBackNoMoreThanItBrought) {
  for (double mass : {0.02, 0.045, 0.2}) {
    for (int delay : {0, 1, 3}) {
      for (double step : {0.0, kOmniStep_m, 0.2e-3}) {
        for (const Impedance& wall : {Impedance{0.0, 1e6}, Impedance{0.0, 1000.0}}) {
          const ArmDynamics dynamics = arm(mass, step, delay);
          Touch touch(dynamics, wall);
          SimulatedArm bouncing(dynamics, kT);
          bouncing.v = -0.05;
          bouncing.friction_N_s_m = 0.0;
          const double brought_J = 0.5 * mass * bouncing.v * bouncing.v;
          double most_N = 0.0;
          bool came_back = false;
          for (int i = 0; i < 1000 && !came_back; ++i) {
            bouncing.tick(touch);
            most_N = std::max(most_N, touch.sent_N.x);
            came_back = bouncing.x > 0.0 && bouncing.v > 0.0;
          }
          const double returned_J = 0.5 * mass * bouncing.v * bouncing.v;
          SCOPED_TRACE(testing::Message() << mass << " kg, delay " << delay << ", encoder " << step
                                          << " m, k " << wall.stiffness);
          EXPECT_GT(most_N, 0.05) << "there was a wall";
          EXPECT_TRUE(came_back || std::abs(bouncing.v) < 0.05);
          EXPECT_LE(returned_J, brought_J + unseen_J(dynamics));
          EXPECT_LE(bouncing.most_given_J, unseen_J(dynamics));
        }
      }
    }
  }
}

TEST(BoundedController, GivesOutNoEnergyUnderADeadWeight) {
  for (double mass : {0.02, 0.045, 0.2}) {
    for (int delay : {0, 1, 3}) {
      const ArmDynamics dynamics = arm(mass, 0.0, delay);
      Touch touch(dynamics, {0.0, 1e6});
      SimulatedArm pushed(dynamics, kT);
      pushed.v = -0.05;
      pushed.push_N = -1.0;
      for (int i = 0; i < 2000; ++i) pushed.tick(touch);
      EXPECT_LE(pushed.most_given_J, unseen_J(dynamics)) << mass << " kg, delay " << delay;
      EXPECT_LT(pushed.x, 0.002) << "and it lies in the wall";
      EXPECT_GT(pushed.x, -0.1);
    }
  }
}

TEST(BoundedController, CountsTheEnergyOfAForceInThePeriodInWhichItActs) {
  for (int delay : {0, 1, 3, kMaxDelayTicks}) {
    BoundedController controller(arm(0.045, 0.0, delay), kT);
    constexpr int kSent = 30;
    const double v = -0.1, force_N = 0.1;
    double before_J = 0.0;
    for (int n = 0; n < kSent + kMaxDelayTicks + 20; ++n) {
      ControllerInput in;
      in.position_m.x = 1.0 + v * kT * n;  // in air, so that nothing else counts
      in.velocity_m_s.x = v;
      // One force, given out by tick kSent.
      if (n == kSent + 1) in.last_sent_N.x = force_N;
      controller.limit({});
      controller.bound(in);
      const double gained_J = controller.credit_J() - before_J;
      before_J = controller.credit_J();
      if (n == kSent + 1 + delay) {
        EXPECT_NEAR(gained_J, -force_N * v * kT, 0.05 * std::abs(force_N * v * kT))
            << "delay " << delay;
      } else {
        ASSERT_EQ(gained_J, 0.0) << "delay " << delay << ", tick " << n;
      }
    }
  }
}

}  // namespace
}  // namespace trephine
