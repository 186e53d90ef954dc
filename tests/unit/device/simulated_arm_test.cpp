// The simulated arm as the host sees it, against closed formulas.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "device_support.h"

namespace trephine {
namespace {

using test::Bench;
using test::exactOmni;
using test::kTick_s;
using test::omni;

constexpr double kMass = 0.045;
constexpr double kPlant = 0.05;

TEST(SimulatedArm, RestsAtTheCentreUntilAHandTakesIt) {
  Bench bench(omni());
  ASSERT_TRUE(bench.device && bench.start());
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(bench.tick());
  EXPECT_EQ(bench.position(), Vec3(0.0));
  EXPECT_EQ(bench.states[0].sequence, 100u);
  EXPECT_EQ(bench.states[0].time_ns, 100'000'000);
  EXPECT_EQ(bench.states[0].flags, std::uint32_t(TREPHINE_ARM_CALIBRATED));
}

TEST(SimulatedArm, AFreeArmUnderConstantForceFollowsItsFormula) {
  // m x'' = f - c x'  =>  x = f/c (t - m/c (1 - exp(-c t/m)))
  Bench bench(exactOmni());
  ASSERT_TRUE(bench.device && bench.start());
  bench.hold(Vec3(0.0), 0.0, 0.0);
  const double f = 0.1;
  bench.push({0.0, -f, 0.0});
  for (int i = 1; i <= 200; ++i) {
    ASSERT_TRUE(bench.tick());
    const double t = i * kTick_s;
    const double expected = -f / kPlant * (t + kMass / kPlant * std::expm1(-kPlant * t / kMass));
    ASSERT_NEAR(bench.position().y, expected, 1e-8) << "at " << t << " s";
  }
  EXPECT_LT(bench.position().y, -0.04);
}

Json withFriction(double friction_N) {
  Json json = exactOmni();
  json["arm"]["friction_N"] = {{"value", friction_N}, {"source", "this test"}, {"verified", true}};
  return json;
}

TEST(SimulatedArm, ItsFrictionHoldsWhatIsWeakerAndTakesItsPartOfTheRestInAnyDirection) {
  const Vec3 oblique = glm::normalize(Vec3(1.0, -2.0, 0.5));
  for (const Vec3& along : {Vec3(1, 0, 0), Vec3(0, -1, 0), oblique}) {
    Bench bench(withFriction(0.26));
    ASSERT_TRUE(bench.device && bench.start());
    EXPECT_EQ(bench.device->capabilities(0).friction_N, 0.26);
    bench.hold(Vec3(0.0), 0.0, 0.0);
    bench.push(0.259 * along);
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(bench.tick());
    EXPECT_EQ(bench.position(), Vec3(0.0));
    bench.push(0.36 * along);
    for (int i = 1; i <= 100; ++i) {
      ASSERT_TRUE(bench.tick());
      const double t = i * kTick_s, f = 0.10;
      const double expected = f / kPlant * (t + kMass / kPlant * std::expm1(-kPlant * t / kMass));
      ASSERT_NEAR(glm::dot(bench.position(), along), expected, 1e-6) << "at " << t << " s";
      ASSERT_LT(glm::length(bench.position() - expected * along), 1e-6);
    }
  }
}

TEST(SimulatedArm, WhatPressesItAgainstItsEdgeOvercomesNoFrictionAlongTheEdge) {
  Bench bench(withFriction(0.26));
  ASSERT_TRUE(bench.device && bench.start());
  bench.hold(Vec3(0.0), 0.0, 0.0);
  bench.push({2.0, 0.0, 0.0});
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(bench.tick());
  EXPECT_EQ(bench.position().x, 0.08);
  const double y = bench.position().y;
  bench.push({1.0, 0.2, 0.0});
  for (int i = 0; i < 500; ++i) ASSERT_TRUE(bench.tick());
  EXPECT_EQ(bench.position().y, y) << "0.2 N is less than its friction";
  EXPECT_TRUE(bench.states[0].flags & TREPHINE_ARM_AT_LIMIT);
  bench.push({0.1, 0.0, 0.0});
  ASSERT_TRUE(bench.tick());
  EXPECT_TRUE(bench.states[0].flags & TREPHINE_ARM_AT_LIMIT) << "it rests there";
  bench.push({1.0, 0.3, 0.0});
  for (int i = 0; i < 500; ++i) ASSERT_TRUE(bench.tick());
  EXPECT_GT(bench.position().y, y + 0.001);
}

TEST(SimulatedArm, AHandBringsAnArmWithFrictionNoNearerThanItsSpringOvercomesIt) {
  Bench bench(withFriction(0.26));
  ASSERT_TRUE(bench.device && bench.start());
  const double k = 300.0;
  bench.hold({0.010, 0.0, 0.0}, k, 2.0);
  double last = 0.0;
  for (int i = 0; i < 2000; ++i) {
    ASSERT_TRUE(bench.tick());
    last = bench.position().x;
  }
  EXPECT_LE(std::abs(last - 0.010), 0.26 / k + 1e-9);
  EXPECT_GT(std::abs(last - 0.010), 1e-5);
  ASSERT_TRUE(bench.tick());
  EXPECT_EQ(bench.position().x, last) << "it rests";
}

// A mass let go at x0 = step from rest at the hand's pose 0.
double oscillator(double step, double k, double damping, double t) {
  const double decay = damping / (2.0 * kMass);
  const double omega = std::sqrt(k / kMass - decay * decay);
  return step * std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
}

TEST(SimulatedArm, AStepOfTheHandIsADampedOscillation) {
  for (const auto& [k, b] : {std::pair{300.0, 2.0}, {1000.0, 10.0}, {300.0, 0.0}}) {
    Bench bench(exactOmni());
    ASSERT_TRUE(bench.device && bench.start());
    const double step = 0.010;
    bench.hold({step, 0.0, 0.0}, k, b);
    double worst = 0.0;
    for (int i = 1; i <= 500; ++i) {
      ASSERT_TRUE(bench.tick());
      const double expected = step - oscillator(step, k, b + kPlant, i * kTick_s);
      worst = std::max(worst, std::abs(bench.position().x - expected));
    }
    EXPECT_LT(worst, 2e-6) << "k " << k << " b " << b;
  }
}

TEST(SimulatedArm, ALongExchangeIsIntegratedAsFinelyAsManyShortOnes) {
  Bench coarse(exactOmni()), fine(exactOmni());
  ASSERT_TRUE(coarse.device && fine.device && coarse.start() && fine.start());
  for (Bench* bench : {&coarse, &fine}) bench->hold({0.01, 0.0, 0.0}, 1000.0, 1.0);
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(coarse.tick(0.02));
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(fine.tick(0.0002));
  EXPECT_NEAR(coarse.position().x, fine.position().x, 2e-6);
  EXPECT_EQ(coarse.states[0].time_ns, fine.states[0].time_ns);
}

TEST(SimulatedArm, AHandThatCarriesALoadGivesWayByForceOverStiffness) {
  Bench bench(exactOmni());
  ASSERT_TRUE(bench.device && bench.start());
  bench.hold(Vec3(0.0), 300.0, 2.0);
  bench.push({1.5, 0.0, -0.9});
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(bench.tick());
  EXPECT_NEAR(bench.position().x, 1.5 / 300.0, 1e-9);
  EXPECT_NEAR(bench.position().z, -0.9 / 300.0, 1e-9);
}

TEST(SimulatedArm, ReadsWholeEncoderSteps) {
  Json in_steps = exactOmni();
  in_steps["arm"]["encoder_step_m"] = omni()["arm"]["encoder_step_m"];
  Bench coarse(in_steps), exact(exactOmni());
  ASSERT_TRUE(coarse.device && exact.device && coarse.start() && exact.start());
  const double step = 0.055e-3;
  bool differs = false;
  for (Bench* bench : {&coarse, &exact}) bench->hold({0.02, -0.013, 0.0071}, 300.0, 2.0);
  for (int i = 0; i < 300; ++i) {
    ASSERT_TRUE(coarse.tick() && exact.tick());
    for (int axis = 0; axis < 3; ++axis) {
      const double reading = coarse.position()[axis];
      ASSERT_EQ(reading, std::round(reading / step) * step);
      ASSERT_LE(std::abs(reading - exact.position()[axis]), 0.5 * step * (1 + 1e-9));
      differs = differs || reading != exact.position()[axis];
    }
  }
  EXPECT_TRUE(differs);
}

TEST(SimulatedArm, StopsAtTheEdgeOfItsWorkspaceAndSaysSo) {
  Bench bench(exactOmni());
  ASSERT_TRUE(bench.device && bench.start());
  bench.hold({0.5, -0.5, 0.0}, 300.0, 2.0);
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(bench.tick());
    ASSERT_LE(bench.position().x, 0.080);
    ASSERT_GE(bench.position().y, -0.060);
  }
  EXPECT_EQ(bench.position(), Vec3(0.080, -0.060, 0.0));
  EXPECT_TRUE(bench.states[0].flags & TREPHINE_ARM_AT_LIMIT);
  bench.hold(Vec3(0.0), 300.0, 2.0);
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(bench.tick());
  EXPECT_FALSE(bench.states[0].flags & TREPHINE_ARM_AT_LIMIT);
  EXPECT_NEAR(bench.position().x, 0.0, 1e-6);
}

TEST(SimulatedArm, LosesItsSpeedAtTheEdge) {
  Bench bench(exactOmni());
  ASSERT_TRUE(bench.device && bench.start());
  bench.hold(Vec3(0.0), 0.0, 0.0);
  bench.push({3.0, 0.0, 0.0});
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(bench.tick());  // struck the edge at about 3 m/s
  ASSERT_EQ(bench.position().x, 0.080);
  const double f = 1.0;
  bench.push({-f, 0.0, 0.0});
  for (int i = 1; i <= 50; ++i) {
    ASSERT_TRUE(bench.tick());
    const double t = i * kTick_s;
    const double away = f / kPlant * (t + kMass / kPlant * std::expm1(-kPlant * t / kMass));
    ASSERT_NEAR(bench.position().x, 0.080 - away, 1e-8) << "at " << t << " s";
  }
}

TEST(SimulatedArm, NoForceNoGainOfEnergy) {
  // Without damping anywhere the arm swings for ever, and never wider than it began.
  Json json = exactOmni();
  json["arm"]["plant_damping_Ns_per_m"]["value"] = 0.0;
  Bench bench(json);
  ASSERT_TRUE(bench.device);
  bench.hold({0.010, 0.0, 0.0}, 300.0, 0.0);
  ASSERT_TRUE(bench.start());
  bench.hold(Vec3(0.0), 300.0, 0.0);
  double widest = 0.0, late = 0.0;
  for (int i = 0; i < 20000; ++i) {
    ASSERT_TRUE(bench.tick());
    widest = std::max(widest, std::abs(bench.position().x));
    if (i >= 19000) late = std::max(late, std::abs(bench.position().x));
  }
  EXPECT_LE(widest, 0.010 * (1 + 1e-9));
  EXPECT_GT(late, 0.010 * 0.999);  // nor does the integration take any away
}

TEST(SimulatedArm, ADampedArmSwingsLessAndLess) {
  Bench bench(exactOmni());
  ASSERT_TRUE(bench.device);
  bench.hold({0.010, -0.020, 0.015}, 1000.0, 0.0);
  ASSERT_TRUE(bench.start());
  bench.hold(Vec3(0.0), 1000.0, 0.5);
  double last = 1.0;
  for (int window = 0; window < 10; ++window) {
    double widest = 0.0;
    for (int i = 0; i < 60; ++i) {  // two thirds of a period and more
      ASSERT_TRUE(bench.tick());
      widest = std::max(widest, glm::length(bench.position()));
    }
    EXPECT_LT(widest, last);
    last = widest;
  }
}

TEST(SimulatedArm, TheStiffestHandStaysFinite) {
  Bench bench(exactOmni());
  ASSERT_TRUE(bench.device && bench.start());
  bench.hold({0.03, 0.0, 0.0}, 1e9, 1e9);
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(bench.tick());
    ASSERT_TRUE(isFinite(bench.position()));
    ASSERT_LE(std::abs(bench.position().x), 0.080);
  }
}

TEST(SimulatedArm, AForceAboveThePeakIsShortened) {
  Bench strong(exactOmni()), peak(exactOmni());
  ASSERT_TRUE(strong.device && peak.device && strong.start() && peak.start());
  strong.push({300.0, -400.0, 0.0});
  peak.push({3.3 * 0.6, -3.3 * 0.8, 0.0});
  for (int i = 0; i < 500; ++i) ASSERT_TRUE(strong.tick() && peak.tick());
  EXPECT_NEAR(glm::distance(strong.position(), peak.position()), 0.0, 1e-9);
  strong.push({1e308, 1e308, 0.0});
  ASSERT_TRUE(strong.tick());
  EXPECT_TRUE(isFinite(strong.position()));
}

TEST(SimulatedArm, TurnsWithTheHand) {
  Bench bench(omni());
  ASSERT_TRUE(bench.device && bench.start());
  Pose pose;
  pose.orientation = Quat(2.0, 0.0, 2.0, 0.0);
  bench.device->setTarget(0, pose, 300.0, 2.0);
  ASSERT_TRUE(bench.tick());
  EXPECT_NEAR(bench.states[0].orientation[0], std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(bench.states[0].orientation[2], std::sqrt(0.5), 1e-15);
}

TEST(SimulatedArm, AnImpossibleHandIsIgnored) {
  Bench bench(exactOmni());
  ASSERT_TRUE(bench.device && bench.start());
  bench.hold({0.01, 0.0, 0.0}, 300.0, 2.0);
  bench.hold({std::nan(""), 0.0, 0.0}, 300.0, 2.0);
  bench.hold({0.0, 0.0, 0.0}, -1.0, 2.0);
  bench.hold({0.0, 0.0, 0.0}, 300.0, INFINITY);
  Pose no_rotation;
  no_rotation.orientation = Quat(0.0, 0.0, 0.0, 0.0);
  bench.device->setTarget(0, no_rotation, 300.0, 2.0);
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(bench.tick());
  EXPECT_NEAR(bench.position().x, 0.01, 1e-6);
  EXPECT_EQ(bench.states[0].orientation[0], 1.0);
}

TEST(SimulatedArm, TwoArmsMoveOnTheirOwn) {
  Bench bench(exactOmni(), 2);
  ASSERT_TRUE(bench.device && bench.start());
  bench.hold({0.01, 0.0, 0.0}, 300.0, 2.0, 0);
  bench.hold({0.0, 0.02, 0.0}, 300.0, 2.0, 1);
  bench.push({0.0, 0.0, 0.3}, 1);
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(bench.tick());
  EXPECT_NEAR(glm::distance(bench.position(0), Vec3(0.01, 0.0, 0.0)), 0.0, 1e-8);
  EXPECT_NEAR(glm::distance(bench.position(1), Vec3(0.0, 0.02, 0.001)), 0.0, 1e-8);
}

// Bits of everything that a fixed, busy second of two arms reports.
std::vector<double> busySecond() {
  Bench bench(omni(), 2);
  std::vector<double> seen;
  if (!bench.device || !bench.start()) return seen;
  for (int i = 0; i < 1000; ++i) {
    const double s = (i % 97) / 97.0;
    bench.hold({0.1 * s, 0.05 - 0.1 * s, 0.03 * s}, 300.0 + i, 2.0, 0);
    bench.hold({-0.02, 0.2 * s, 0.0}, 1000.0, 10.0, 1);
    bench.push({4.0 * s, -1.0, 0.3}, 0);
    bench.push({0.0, 2.0 - s, s}, 1);
    if (!bench.tick()) return {};
    for (std::size_t arm = 0; arm < 2; ++arm) {
      for (int axis = 0; axis < 3; ++axis) seen.push_back(bench.position(arm)[axis]);
      seen.push_back(bench.states[arm].flags);
    }
  }
  return seen;
}

TEST(SimulatedArm, TheSameInputsGiveTheSameBits) {
  const std::vector<double> first = busySecond(), second = busySecond();
  ASSERT_EQ(first.size(), 8000u);
  ASSERT_EQ(first.size(), second.size());
  EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof(double)), 0);
}

}  // namespace
}  // namespace trephine
