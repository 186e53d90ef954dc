// Whether encoders and motors agree, on arms in hands, with what may be wrong with them.
#include "session/motor_encoder_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace trephine {
namespace {

using Phase = MotorEncoderCheck::Phase;
using Matrix = glm::dmat3;
constexpr double kTick_s = 1e-3, kWell = 0.07, kWrong = -0.05;  // the limits of commissioning
const Matrix kRight(1.0);

Matrix reflected(Vec3 along) {
  along /= glm::length(along);
  return kRight - 2.0 * glm::outerProduct(along, along);
}
Matrix without(Vec3 along) {
  along /= glm::length(along);
  return kRight - glm::outerProduct(along, along);
}

struct Plant {
  double mass_kg = 0.045, hand_N_per_m = 300.0, hand_Ns_per_m = 3.0;
  double step_m = 5.5e-5, scatter_m = 0.0, friction_N = 0.0;
  Vec3 scatters{1.0};  // which axes
  double jumps_of_samples = 0.0;
  Matrix encoder = kRight, motor = kRight;
  double drift_m_s = 0.0, tremor_m = 0.0, sway_m = 0.0;  // of the hand: steady, 10 Hz, 1 Hz
  int delay = 0;       // ticks, beyond the one that every force takes
  int samples_of = 1;  // ticks a sample of the device lasts
  double stated_kg = 0.045, most_N = 0.88;
  bool by_button = true;
  int late_every = 0;  // ticks that come late
  int late_ticks = 4;  // by so many

  Vec3 x_m{0.0}, v_m_s{0.0}, moved_m{0.0};
  std::vector<Vec3> sent_N;
  double farthest_m = 0.0, time_s = 0.0;
  MotorEncoderCheck answer;
  HandSample sample;
  std::mt19937 random{7};

  Vec3 reading() {
    std::normal_distribution<double> scatter(0.0, 1.0);
    std::bernoulli_distribution jump(jumps_of_samples);
    Vec3 at = encoder * x_m;
    if (jump(random)) at.y += 0.02;
    for (int i = 0; i < 3; ++i) {
      at[i] += scatters[i] * scatter_m * scatter(random);
      if (step_m > 0.0) at[i] = std::round(at[i] / step_m) * step_m;
    }
    return at;
  }
  Vec3 hand() const {
    const double turn = 2.0 * std::numbers::pi * time_s;
    return moved_m + Vec3(drift_m_s * time_s + sway_m * std::sin(turn),
                          tremor_m * std::sin(9.7 * turn), tremor_m * std::cos(9.7 * turn));
  }
  void move(const Vec3& force_N) {
    constexpr int kSub = 20;
    for (int n = 0; n < kSub; ++n) {
      Vec3 rub(0.0);
      for (int i = 0; i < 3; ++i) rub[i] = friction_N * std::tanh(v_m_s[i] / 0.005);
      v_m_s += (kTick_s / kSub) / mass_kg *
               (force_N + hand_N_per_m * (hand() - x_m) - hand_Ns_per_m * v_m_s - rub);
      x_m += (kTick_s / kSub) * v_m_s;
      time_s += kTick_s / kSub;
    }
    farthest_m = std::max(farthest_m, glm::length(x_m - hand()));
  }
  Vec3 tick() {
    const bool late = late_every > 0 && sent_N.size() % std::size_t(late_every) == 3;
    for (int n = 0; late && n < late_ticks; ++n) move(motor * acting());
    const bool fresh = sent_N.size() % std::size_t(samples_of) == 0;
    if (fresh) sample.position_m = reading();
    sent_N.push_back(answer.tick(sample, fresh, late, kTick_s));
    move(motor * acting());
    return sent_N.back();
  }
  Vec3 acting() const {
    const int at = int(sent_N.size()) - 1 - delay;
    return at >= 0 ? sent_N[std::size_t(at)] : Vec3(0.0);
  }
  // Asked, taken, until it is over.
  const MotorEncoderCheck& run() {
    answer.ask(stated_kg, kTick_s * delay, most_N, 10.0, step_m);
    tick();
    sample.button = by_button;
    for (int n = 0; n < 15000 && MotorEncoderCheck::runs(answer.phase()); ++n) {
      if (!by_button && n == 50) moved_m.x = 0.01;
      tick();
    }
    return answer;
  }
  // As commissioning says it: 1 well, 0 to be looked at, -1 wrong.
  int verdict() {
    if (run().phase() != Phase::done || !answer.pushed()) return 0;
    const MotorEncoderCheck::Response& r = answer.response();
    if (r.least < -3.0 * r.error) return r.least < kWrong ? -1 : 0;
    return r.least > 3.0 * r.error && std::min(r.least, r.weakest) > kWell ? 1 : 0;
  }
};

TEST(MotorEncoderCheck, AnArmThatIsWellGoesWhereItIsPushedInAnyHand) {
  for (const double hand : {100.0, 300.0, 500.0}) {
    for (const double step : {0.0, 5.5e-5}) {
      for (const double drift : {0.0, 0.03}) {
        for (const int delay : {0, 3, 6}) {
          for (const double tremor : {0.0, 1e-4}) {
            Plant arm;
            arm.hand_N_per_m = hand;
            arm.step_m = step;
            arm.drift_m_s = drift;
            arm.delay = delay;
            arm.tremor_m = tremor;
            EXPECT_EQ(arm.verdict(), 1)
                << hand << " N/m, step " << step << ", drift " << drift << ", delay " << delay
                << ": " << arm.answer.response().least << " +- " << arm.answer.response().error;
            EXPECT_LE(arm.answer.noise_m(), std::max(step, 1e-5));
            EXPECT_LT(arm.farthest_m, 0.005);
          }
        }
      }
    }
  }
}

TEST(MotorEncoderCheck, AFreeArmGoesAsItsMassSaysAtMostThreeMillimetresAndRests) {
  Plant arm;
  arm.hand_N_per_m = arm.hand_Ns_per_m = 0.0;
  arm.step_m = 0.0;
  ASSERT_EQ(arm.run().phase(), Phase::done);
  EXPECT_NEAR(arm.answer.response().least, 1.0, 0.02);
  EXPECT_NEAR(arm.answer.response().weakest, 1.0, 0.02);
  EXPECT_LT(glm::length(arm.v_m_s), 1e-6);
  EXPECT_LT(arm.farthest_m, std::sqrt(3.0) * 0.0036) << "along three axes";
}

TEST(MotorEncoderCheck, WhatIsReversedIsFoundWhereverItPoints) {
  const Matrix wrongs[] = {reflected({1, 0, 0}), reflected({0, 1, 0}), reflected({1, 1, 0}),
                           reflected({1, 1, 1}), Matrix(0, 1, 0, 1, 0, 0, 0, 0, 1)};
  for (const Matrix& wrong : wrongs) {
    for (const double mass : {0.045, 0.15}) {
      for (const bool motor : {false, true}) {
        Plant arm;
        arm.mass_kg = arm.stated_kg = mass;
        arm.tremor_m = 1e-4;
        arm.drift_m_s = 0.02;
        (motor ? arm.motor : arm.encoder) = wrong;
        EXPECT_EQ(arm.verdict(), -1) << arm.answer.response().least;
      }
    }
  }
  Plant arm;
  arm.encoder = reflected({0, 1, 1});
  arm.run();
  const Vec3 along = arm.answer.response().along;
  EXPECT_NEAR(std::abs(glm::dot(along, Vec3(0, 1, 1)) / std::sqrt(2.0)), 1.0, 0.05)
      << "and it says along what";
}

TEST(MotorEncoderCheck, AMotorThatIsCutOffOrAnEncoderThatIsStuckIsNotPassed) {
  for (const Vec3& along : {Vec3(0, 1, 0), Vec3(1, 1, 1), Vec3(1, 0, 1)}) {
    for (const bool motor : {false, true}) {
      Plant arm;
      (motor ? arm.motor : arm.encoder) = without(along);
      EXPECT_EQ(arm.verdict(), 0);
      EXPECT_LT(arm.answer.response().weakest, 0.05);
    }
  }
  Plant rubs;  // as an Omni does
  rubs.friction_N = 0.26;
  EXPECT_EQ(rubs.verdict(), 1) << rubs.answer.response().least;
}

TEST(MotorEncoderCheck, AHandThatMovesOrIsFirmFailsNoGoodArm) {
  for (const double mass : {0.045, 0.15}) {
    for (const double hand : {400.0, 1000.0, 3000.0}) {
      for (const double tremor : {5e-4, 2e-3}) {
        Plant arm;
        arm.mass_kg = arm.stated_kg = mass;
        arm.hand_N_per_m = hand;
        arm.hand_Ns_per_m = hand / 120.0;
        arm.tremor_m = tremor;
        arm.sway_m = 0.015;
        EXPECT_GE(arm.verdict(), 0) << mass << " kg, " << hand << " N/m, " << tremor;
      }
    }
  }
}

TEST(MotorEncoderCheck, ItsPushesAreTheSameWhereTicksAreLateOrSamplesAreRare) {
  Plant late;
  late.late_every = 403;
  EXPECT_EQ(late.verdict(), 1) << late.answer.response().least;
  EXPECT_LT(late.farthest_m, 0.006);
  Plant far;  // the hand goes on meanwhile, by 8 mm from one sample to the next
  far.late_every = 403;
  far.late_ticks = 80;
  far.drift_m_s = 0.1;
  EXPECT_EQ(far.verdict(), 1) << far.answer.response().least;
  Plant always;
  always.late_every = 9;
  EXPECT_EQ(always.run().phase(), Phase::late) << "it does not try for ever";
  Plant rare;  // a device of 500 Hz
  rare.samples_of = 2;
  EXPECT_EQ(rare.verdict(), 1) << rare.answer.response().least;
  EXPECT_LE(rare.answer.noise_m(), rare.step_m);
}

TEST(MotorEncoderCheck, SamplesThatScatterOrJumpAreSeenAndThoseThatSayNothingAreNotPushed) {
  Plant arm;
  arm.scatter_m = 1e-4;
  arm.run();
  EXPECT_NEAR(arm.answer.noise_m(), 1e-4, 2e-5);
  EXPECT_TRUE(arm.answer.pushed());
  Plant one;
  one.scatter_m = 1e-4;
  one.scatters = {0.0, 0.0, 1.0};
  EXPECT_NEAR(one.run().noise_m(), 1e-4, 2e-5) << "the worst axis counts";
  Plant bad;
  bad.scatter_m = 3e-3;
  EXPECT_EQ(bad.run().phase(), Phase::done);
  EXPECT_GT(bad.answer.noise_m(), 2e-3);
  Plant jumps;
  jumps.jumps_of_samples = 0.01;
  jumps.run();
  EXPECT_GT(jumps.answer.noise_m(), 2e-3);
  for (const Plant* none : {&bad, &jumps}) {
    EXPECT_FALSE(none->answer.pushed());
    for (const Vec3& force : none->sent_N) EXPECT_EQ(force, Vec3(0.0));
  }
}

TEST(MotorEncoderCheck, BeginsWhereTheArmIsMovedAndNotWhereASampleJumps) {
  Plant moved;
  moved.by_button = false;
  EXPECT_EQ(moved.verdict(), 1);
  MotorEncoderCheck glitch;
  glitch.ask(0.045, 0.0, 0.88, 1.0, 5.5e-5);
  for (int n = 0; n < 900; ++n) {
    const Vec3 at_m(n % 50 > 40 ? 0.02 : 0.0, 0.0, 0.0);
    EXPECT_EQ(glitch.tick({at_m, false, false, false}, true, false, kTick_s), Vec3(0.0));
  }
  EXPECT_EQ(glitch.phase(), Phase::waiting);
}

TEST(MotorEncoderCheck, WithoutAHandOrAMassThereIsNoForce) {
  Plant arm;
  arm.answer.ask(0.045, 0.0, 0.88, 1.0, 5.5e-5);
  for (int n = 0; n < 1200; ++n) EXPECT_EQ(arm.tick(), Vec3(0.0));
  EXPECT_EQ(arm.answer.phase(), Phase::untouched);
  Plant holder;
  holder.sample.no_hand = true;
  holder.sample.button = true;
  holder.answer.ask(0.045, 0.0, 0.88, 1.0, 5.5e-5);
  for (int n = 0; n < 1200; ++n) EXPECT_EQ(holder.tick(), Vec3(0.0));
  EXPECT_EQ(holder.answer.phase(), Phase::untouched);
  for (const auto& [mass, force] : {std::pair(0.0, 0.88), {1e-4, 0.88}, {0.045, 0.0}}) {
    Plant states;
    states.stated_kg = mass;
    states.most_N = force;
    EXPECT_EQ(states.run().phase(), Phase::done);
    EXPECT_FALSE(states.answer.pushed());
  }
}

TEST(MotorEncoderCheck, WhoLetsGoOfTheButtonOrTheArmHasNoForceInThatTick) {
  for (const int how : {0, 1, 2}) {
    Plant arm;
    arm.answer.ask(0.045, 0.0, 0.88, 10.0, 5.5e-5);
    arm.tick();
    arm.sample.button = true;
    for (int n = 0; n < 3000 && glm::length(arm.tick()) == 0.0;) ++n;
    ASSERT_GT(glm::length(arm.sent_N.back()), 0.0);
    if (how == 0) arm.sample.button = false;
    if (how == 1) arm.sample.no_hand = true;
    if (how == 2) arm.sample.away = true;
    EXPECT_EQ(arm.tick(), Vec3(0.0));
    EXPECT_EQ(arm.answer.phase(), Phase::lost);
  }
}

TEST(MotorEncoderCheck, AnArmThatFallsOrIsFarLighterThanItSaysIsLetGoOf) {
  Plant light;
  light.mass_kg = 0.01;  // stated 45 g
  light.hand_N_per_m = light.hand_Ns_per_m = 0.0;
  EXPECT_EQ(light.run().phase(), Phase::lost);
  EXPECT_LT(light.farthest_m, 0.03);
  Plant falls;
  falls.by_button = false;
  falls.answer.ask(0.045, 0.0, 0.88, 10.0, 5.5e-5);
  falls.sample.button = true;
  for (int n = 0; n < 900; ++n) falls.tick();
  ASSERT_EQ(falls.answer.phase(), Phase::pushing);
  int after = 0;
  for (falls.hand_N_per_m = falls.hand_Ns_per_m = 0.0;
       MotorEncoderCheck::runs(falls.answer.phase()) && after < 1000; ++after) {
    falls.v_m_s.y -= 9.81 * kTick_s;
    falls.tick();
  }
  EXPECT_LT(after, 100);
}

TEST(MotorEncoderCheck, NeverPushesMoreThanItsBoundNorAlongTwoAxes) {
  for (const double most : {0.88, 0.3}) {
    Plant arm;
    arm.most_N = most;
    arm.run();
    double largest_N = 0.0;
    for (const Vec3& force : arm.sent_N) {
      largest_N = std::max(largest_N, glm::length(force));
      ASSERT_LE((force.x != 0.0) + (force.y != 0.0) + (force.z != 0.0), 1);
    }
    EXPECT_EQ(largest_N, std::min(0.8, most));
    EXPECT_LT(arm.sent_N.size(), 5000u);
  }
  Plant heavy;  // its pushes are shorter than its mass would have them
  heavy.mass_kg = heavy.stated_kg = 1.0;
  heavy.run();
  int longest = 0, now = 0;
  Vec3 last(0.0);
  for (const Vec3& force : heavy.sent_N) {
    now = force != Vec3(0.0) && force == last ? now + 1 : 1;
    last = force;
    if (force != Vec3(0.0)) longest = std::max(longest, now);
  }
  EXPECT_EQ(longest, 40);
}

}  // namespace
}  // namespace trephine
