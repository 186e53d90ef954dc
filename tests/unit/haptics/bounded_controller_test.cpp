// What the bounded controller sends: of which tissue how much, when, and in which direction. Its
// energy, what it learns and what an arm renders have files of their own.
#include "haptics/bounded_controller.h"

#include "bounded_support.h"
#include "haptics/controllers.h"
#include "haptics/safety.h"

namespace trephine {
namespace {

using test::arm;
using test::kOmniStep_m;
using test::kT;
using test::Numbers;
using test::Touch;

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
    ArmDynamics dynamics = arm(numbers.decadesBetween(0.005, 0.5), step);
    const double rate_hz = numbers.decadesBetween(250.0, 8000.0);
    const double delay = 0.5 * (i % (2 * kMaxDelayTicks + 1));
    dynamics.delay_s = delay / rate_hz;
    const Renderable most = renderable(dynamics, rate_hz, delay, {});
    ASSERT_GT(most.b_max, 0.0);
    ASSERT_GT(most.k_max, 0.0);
    const Impedance below{0.9 * most.b_max, 0.9 * most.k_max};
    const Impedance above{1.1 * most.b_max, 1.1 * most.k_max};
    const Impedance rock{1e9, 1e9};

    Touch touch(dynamics, rock, 1.0 / rate_hz);
    EXPECT_EQ(touch.controller.limit(below).stiffness, below.stiffness);
    EXPECT_EQ(touch.controller.limit(below).damping, below.damping);
    for (const Impedance& firm : {above, rock}) {
      EXPECT_NEAR(touch.controller.limit(firm).damping, most.b_max, 1e-12 * most.b_max);
    }
    // A wall may be firmer while it is struck, and no longer.
    for (int n = 0; n < int(0.2 * rate_hz); ++n) touch.at(-0.1e-3);
    for (const Impedance& tissue : {below, above, rock, Impedance{1e9, 0.0}, Impedance{0.0, 1e9}}) {
      const Impedance limited = touch.controller.limit(tissue);
      ASSERT_LE(limited.damping, std::min(tissue.damping, most.b_max) * (1.0 + 1e-9));
      ASSERT_LE(limited.stiffness, std::min(tissue.stiffness, most.k_max) * (1.0 + 1e-9));
    }
  }
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

}  // namespace
}  // namespace trephine
