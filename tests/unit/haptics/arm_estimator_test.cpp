#include "haptics/arm_estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace trephine {
namespace {

constexpr double kT = 0.001;
constexpr double kStep_m = 0.055e-3;

ArmDynamics arm(double mass_kg, double encoder_m) {
  ArmDynamics dynamics;
  dynamics.apparent_mass_kg = mass_kg;
  dynamics.encoder_step_m = encoder_m;
  return dynamics;
}

double rounded(double x, double step) { return step > 0.0 ? std::round(x / step) * step : x; }

// Feeds samples of a motion along x from t = 0, with the same force held all the time.
void follow(ArmEstimator& estimator, const std::function<double(double t)>& motion_m,
            double seconds, double held_N, double encoder_m,
            const std::function<void(double t)>& check = [](double) {}) {
  const int ticks = int(std::lround(seconds / kT));
  for (int n = 0; n <= ticks; ++n) {
    const double t = n * kT;
    estimator.update({rounded(motion_m(t), encoder_m), 0.0, 0.0}, {held_N, 0.0, 0.0});
    check(t);
  }
}

TEST(ArmEstimator, FindsAConstantVelocityWithoutBias) {
  for (double mass : {0.005, 0.045, 0.2}) {
    for (double trusted_step : {0.0, kStep_m, 0.2e-3}) {
      ArmEstimator estimator(arm(mass, trusted_step), kT);
      follow(estimator, [](double t) { return 0.01 + 0.05 * t; }, 4.0, 0.0, 0.0);
      EXPECT_NEAR(estimator.velocity_m_s().x, 0.05, 1e-6) << mass << " kg " << trusted_step;
      EXPECT_NEAR(estimator.position_m().x, 0.01 + 0.05 * 4.0, 1e-8);
      EXPECT_NEAR(estimator.handAcceleration_m_s2().x, 0.0, 1e-3);
    }
  }
}

TEST(ArmEstimator, FindsAHandThatPushesSteadily) {
  for (double mass : {0.02, 0.2}) {
    for (double trusted_step : {0.0, kStep_m}) {
      for (double held_N : {0.0, -0.7}) {
        const double hand_N = 0.9, acceleration = (hand_N + held_N) / mass;
        ArmEstimator estimator(arm(mass, trusted_step), kT);
        follow(estimator, [&](double t) { return 0.5 * acceleration * t * t; }, 2.0, held_N, 0.0);
        EXPECT_NEAR(mass * estimator.handAcceleration_m_s2().x, hand_N, 1e-3)
            << mass << " kg " << trusted_step << " m, held " << held_N;
        EXPECT_NEAR(estimator.velocity_m_s().x, acceleration * 2.0, 1e-4);
      }
    }
  }
}

TEST(ArmEstimator, SeesFarLessThanACountAPeriodInAQuantisedRamp) {
  const double count_m_s = kStep_m / kT;
  for (double mass : {0.02, 0.045, 0.2}) {
    for (double v : {0.003, 0.01, 0.1}) {
      ArmEstimator estimator(arm(mass, kStep_m), kT);
      double worst = 0.0, squares = 0.0, of_difference = 0.0, last = 0.0;
      int count = 0;
      const auto motion = [&](double t) { return v * t; };
      follow(estimator, motion, 2.0, 0.0, kStep_m, [&](double t) {
        const double sample = rounded(motion(t), kStep_m);
        if (t > 1.0) {
          const double error = estimator.velocity_m_s().x - v;
          worst = std::max(worst, std::abs(error));
          squares += error * error;
          of_difference += std::pow((sample - last) / kT - v, 2.0);
          ++count;
        }
        last = sample;
      });
      EXPECT_LT(worst, 0.4 * count_m_s) << mass << " kg at " << v << " m/s";
      EXPECT_LT(std::sqrt(squares / count), 0.2 * count_m_s) << mass << " kg at " << v << " m/s";
      EXPECT_LT(squares, 0.6 * of_difference) << "and the backward difference is worse";
      EXPECT_LT(std::abs(estimator.position_m().x - v * 2.0), 0.75 * kStep_m);
    }
  }
}

TEST(ArmEstimator, DoesNotTakeAHeldForceForAHand) {
  const double mass = 0.045, held_N = 2.0;
  ArmEstimator estimator(arm(mass, 0.0), kT);
  follow(
      estimator, [&](double t) { return 0.5 * held_N / mass * t * t; }, 0.5, held_N, 0.0,
      [&](double t) {
        ASSERT_NEAR(mass * estimator.handAcceleration_m_s2().x, 0.0, 1e-6 * held_N) << t;
        ASSERT_NEAR(estimator.velocity_m_s().x, held_N / mass * t, 1e-6) << "at once, at " << t;
      });

  ArmEstimator of_counts(arm(mass, kStep_m), kT);
  follow(
      of_counts, [&](double t) { return 0.5 * held_N / mass * t * t; }, 0.5, held_N, kStep_m,
      [&](double t) {
        ASSERT_LT(mass * std::abs(of_counts.handAcceleration_m_s2().x), 0.15 * held_N) << t;
      });
}

TEST(ArmEstimator, TakesAnArmThatAForceDoesNotMoveForHeld) {
  ArmEstimator estimator(arm(0.045, kStep_m), kT);
  follow(estimator, [](double) { return 0.02; }, 2.0, 1.5, kStep_m);
  EXPECT_NEAR(0.045 * estimator.handAcceleration_m_s2().x, -1.5, 1e-2);
  EXPECT_NEAR(estimator.velocity_m_s().x, 0.0, 1e-3);
}

TEST(ArmEstimator, KeepsTheAxesApart) {
  ArmEstimator estimator(arm(0.045, kStep_m), kT);
  ArmEstimator along_x(arm(0.045, kStep_m), kT);
  for (int n = 0; n < 500; ++n) {
    const double z = 0.01 * std::sin(0.05 * n);
    estimator.update({0.0, 0.3, z}, {0.0, 0.0, -z});
    along_x.update({z, 0.0, 0.0}, {-z, 0.0, 0.0});
  }
  EXPECT_EQ(estimator.velocity_m_s().z, along_x.velocity_m_s().x);
  EXPECT_EQ(estimator.handAcceleration_m_s2().z, along_x.handAcceleration_m_s2().x);
  EXPECT_NEAR(estimator.position_m().y, 0.3, 1e-15);
  EXPECT_EQ(estimator.velocity_m_s().x, 0.0);
  EXPECT_NEAR(estimator.velocity_m_s().y, 0.0, 1e-12);
}

TEST(ArmEstimator, StartsAtRestWhereTheNextSampleIsOnceItHasForgotten) {
  ArmEstimator estimator(arm(0.045, kStep_m), kT);
  follow(estimator, [](double t) { return 0.1 * t; }, 0.5, 0.0, 0.0);
  estimator.forget();
  estimator.update({0.7, -0.2, 0.1}, {3.0, 0.0, 0.0});
  EXPECT_EQ(estimator.position_m(), Vec3(0.7, -0.2, 0.1));
  EXPECT_EQ(estimator.velocity_m_s(), Vec3(0.0));
  EXPECT_EQ(estimator.handAcceleration_m_s2(), Vec3(0.0));
}

TEST(ArmEstimator, LagsMoreTheCoarserTheEncoder) {
  double last = -1.0;
  for (double step : {0.0, 1e-6, 1e-5, kStep_m, 0.2e-3, 1e-3}) {
    const double lag = ArmEstimator(arm(0.045, step), kT).lag_s();
    EXPECT_GE(lag, 0.0);
    EXPECT_GT(lag, last) << step;
    last = lag;
  }
  EXPECT_LT(ArmEstimator(arm(0.045, 0.0), kT).lag_s(), 0.05 * kT) << "exact samples are believed";
}

}  // namespace
}  // namespace trephine
