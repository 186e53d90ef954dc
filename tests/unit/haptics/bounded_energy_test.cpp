// The energy that the bounded controller counts, lets out and keeps.
#include "bounded_support.h"

namespace trephine {
namespace {

using test::arm;
using test::kOmniStep_m;
using test::kT;
using test::SimulatedArm;
using test::Touch;

// What an encoder of this step cannot see, as the bars of the stability grid have it.
double unseen_J(const ArmDynamics& dynamics) {
  return std::max(0.05e-3, 1.0 * dynamics.encoder_step_m);
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
  for (double delay : {0.0, 0.25, 0.5, 1.0, 1.75, 3.0}) {
    for (double acceleration : {1.0, 10.0, 50.0}) {
      Touch touch(arm(0.045, 0.0, delay), {0.0, 500.0});
      for (int i = 0; i < 300; ++i) touch.at(-0.01e-3 * i);
      for (int i = 0; touch.last_m < 0.0; ++i) {
        touch.at(-0.003 + 0.5 * acceleration * (i * kT) * (i * kT));
        ASSERT_GT(touch.sent_N.x, -0.2)
            << "at " << touch.last_m << " m, " << acceleration << " m/s2, delay " << delay;
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

// An arm that rests 7 counts deep, and has as much counted as given out as an encoder cannot see.
struct Drained {
  double stored_J = 0.0, drained_J = 0.0, soon_J = 0.0, late_J = 0.0;  // the credit, but for stored

  explicit Drained(int touch_version) {
    constexpr double kK_N_per_m = 900.0;
    const double deep_m = 7 * kOmniStep_m;
    stored_J = 0.5 * kK_N_per_m * deep_m * deep_m;
    BoundedController controller(arm(0.045, kOmniStep_m), kT, touch_version);
    ControllerInput in;
    in.touching = true;
    const auto tick = [&](double x, double rotation_work_J) {
      in.velocity_m_s.x = (x - in.position_m.x) / kT;
      in.position_m.x = x;
      in.rotation_work_J = rotation_work_J;
      const Impedance allowed = controller.limit({1.0, kK_N_per_m});
      in.demanded_N.x = -kK_N_per_m * x - in.velocity_m_s.x;
      in.rendered =
          springAndDamper({-allowed.stiffness * x, 0.0, 0.0}, allowed.stiffness, allowed.damping);
      in.last_sent_N = controller.bound(in);
    };
    for (int count = 0; count < 7; ++count) {
      for (int i = 0; i < 30; ++i) tick(-count * kOmniStep_m, 0.0);
    }
    for (int i = 0; i < 300; ++i) tick(-deep_m, 0.0);
    for (int i = 0; i < 40; ++i) tick(-deep_m, -1e-6);
    drained_J = controller.credit_J();
    for (int i = 0; i < 100; ++i) tick(-deep_m, 0.0);
    soon_J = controller.credit_J();
    for (int i = 0; i < 2000; ++i) tick(-deep_m, 0.0);
    late_J = controller.credit_J();
  }
};

TEST(BoundedController, GetsBackAtRestTheCreditThatCountsUsedUp) {
  const Drained now(kTouchVersion), before(10);
  ASSERT_LT(before.drained_J, 0.8 * before.stored_J);
  EXPECT_NEAR(before.late_J, before.drained_J, 1e-9) << "it stayed lost";
  EXPECT_GT(now.soon_J, now.drained_J + 5e-6);
  EXPECT_LE(now.soon_J, now.drained_J + 0.1 / 0.5 * unseen_J(arm(0.045, kOmniStep_m)) + 1e-12)
      << "no faster than an encoder hides it in half a second";
  EXPECT_NEAR(now.late_J, now.stored_J, 0.02 * now.stored_J) << "what the spring holds, no more";
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
      in.rendered =
          springAndDamper(in.demanded_N * (allowed.stiffness / kK_N_per_m), allowed.stiffness, 0.0);
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

TEST(BoundedController, GivesABounceBackNoMoreThanItBrought) {
  for (double mass : {0.02, 0.045, 0.2}) {
    for (double delay : {0.0, 0.25, 0.5, 1.0, 1.75, 3.0}) {
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
    for (double delay : {0.0, 0.25, 0.5, 1.0, 1.75, 3.0}) {
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
  for (double delay : {0.0, 0.25, 1.0, 2.5, 3.0, double(kMaxDelayTicks)}) {
    const int whole = int(delay);
    const double share = delay - whole, all_J = 0.1 * 0.1 * kT;
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
      if (n == kSent + 1 + whole) {
        EXPECT_NEAR(gained_J, (1.0 - share) * all_J, 0.05 * all_J) << "delay " << delay;
      } else if (n == kSent + 2 + whole && share > 0.0) {
        EXPECT_NEAR(gained_J, share * all_J, 0.05 * all_J) << "delay " << delay;
      } else {
        ASSERT_EQ(gained_J, 0.0) << "delay " << delay << ", tick " << n;
      }
    }
  }
}

}  // namespace
}  // namespace trephine
