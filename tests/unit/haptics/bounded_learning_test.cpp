// What the bounded controller learns of an arm that is not as it was told, and forgets.
#include "bounded_support.h"

namespace trephine {
namespace {

using test::arm;
using test::kOmniStep_m;
using test::kT;
using test::SimulatedArm;
using test::Touch;

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

}  // namespace
}  // namespace trephine
