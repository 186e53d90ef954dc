#include "haptics/arm_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "haptics/controllers.h"

namespace trephine {
namespace {

constexpr double kT = 0.001;

// An arm that falls onto a wall at 0.05 m/s, a few times, and what its controller finds.
struct FallingArm {
  BoundedController controller;
  double mass_kg, encoder_m;
  std::deque<double> on_the_way;
  double late_share, before_N = 0.0;

  FallingArm(const ArmDynamics& told, double true_kg, double true_delay)
      : controller(told, kT),
        mass_kg(true_kg),
        encoder_m(told.encoder_step_m),
        on_the_way(std::size_t(true_delay), 0.0),
        late_share(true_delay - double(on_the_way.size())) {}

  bool notAsStated(int falls) {
    double sent_N = 0.0, last_m = 0.004;
    for (int fall = 0; fall < falls; ++fall) {
      double x = 0.004, v = -0.05;
      for (int n = 0; n < 300; ++n) {
        const double sample = encoder_m > 0.0 ? std::round(x / encoder_m) * encoder_m : x;
        ControllerInput in;
        in.touching = sample < 0.0;
        in.position_m.x = sample;
        in.velocity_m_s.x = (sample - last_m) / kT;
        in.last_sent_N.x = sent_N;
        last_m = sample;
        const Impedance allowed = controller.limit(in.touching ? Impedance{1.0, 1e5} : Impedance{});
        in.rendered = springAndDamper({in.touching ? -allowed.stiffness * sample : 0.0, 0.0, 0.0},
                                      allowed.stiffness, allowed.damping);
        sent_N = controller.bound(in).x;
        on_the_way.push_back(sent_N);
        for (int i = 0; i < 20; ++i) {
          const double acting_N = i < 20 * late_share ? before_N : on_the_way.front();
          v += kT / 20 * (acting_N - 0.05 * v) / mass_kg;
          x += kT / 20 * v;
        }
        before_N = on_the_way.front();
        on_the_way.pop_front();
      }
    }
    return controller.parts() & kPartArmNotAsStated;
  }
};

ArmDynamics told(double mass_kg, double delay, double encoder_m = 0.0) {
  return {mass_kg, encoder_m, ArmDynamics{}.peak_force_N, delay * kT};
}

TEST(ArmCheck, IsSilentOnAnArmThatIsAsStated) {
  for (double mass : {0.02, 0.045, 0.2}) {
    for (double delay : {0.0, 0.4, 1.0, 1.7, 3.0}) {
      for (double step : {0.0, 0.055e-3, 0.2e-3}) {
        EXPECT_FALSE(FallingArm(told(mass, delay, step), mass, delay).notAsStated(5))
            << mass << " kg, delay " << delay << ", encoder " << step;
      }
    }
  }
}

TEST(ArmCheck, FindsAnArmThatIsLighterThanStatedInItsFirstContacts) {
  for (double times : {2.0, 5.0}) {
    EXPECT_TRUE(FallingArm(told(times * 0.045, 1), 0.045, 1).notAsStated(20)) << times;
  }
}

TEST(ArmCheck, FindsASampleMoreOrLessDelayThanStated) {
  EXPECT_TRUE(FallingArm(told(0.045, 0), 0.045, 1).notAsStated(3)) << "one more";
  EXPECT_TRUE(FallingArm(told(0.045, 2), 0.045, 1).notAsStated(3)) << "one less";
  EXPECT_TRUE(FallingArm(told(0.045, 1.7), 0.045, 2.7).notAsStated(3)) << "of no whole number";
}

TEST(ArmCheck, GoesByNoDelayBeyondThoseThatAreKept) {
  const ArmDynamics late = told(0.045, 100.0);
  EXPECT_EQ(ArmCheck(late, ArmEstimator(late, kT), kT).delaySamples(), double(kMaxDelayTicks));
}

TEST(ArmCheck, KeepsWhatItFoundThroughAnUndo) {
  FallingArm light(told(0.09, 1), 0.045, 1);
  ASSERT_TRUE(light.notAsStated(20));
  light.controller.forget();
  EXPECT_TRUE(light.notAsStated(1));
}

}  // namespace
}  // namespace trephine
