// Whether encoders and motors agree, on arms in hands, with what may be wrong with them.
#include "session/arm_answer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace trephine {
namespace {

using Phase = ArmAnswer::Phase;
constexpr double kTick_s = 1e-3;

struct Plant {
  double mass_kg = 0.045, hand_N_per_m = 300.0, hand_Ns_per_m = 2.0;
  double step_m = 5.5e-5, scatter_m = 0.0, friction_N = 0.0;
  Vec3 encoder{1.0}, motor{1.0};  // -1: reversed; 0: cut off
  double drift_m_s = 0.0;         // of the hand
  int delay = 0;                  // ticks, beyond the one that every force takes

  Vec3 x_m{0.0}, v_m_s{0.0}, hand_m{0.0};
  std::vector<Vec3> sent_N;
  double farthest_m = 0.0;
  ArmAnswer answer;
  ForceTest::Sample sample;
  std::mt19937 random{7};

  Vec3 reading() {
    std::normal_distribution<double> scatter(0.0, 1.0);
    Vec3 at = x_m * encoder;
    for (int i = 0; i < 3; ++i) {
      at[i] += scatter_m * scatter(random);
      if (step_m > 0.0) at[i] = std::round(at[i] / step_m) * step_m;
    }
    return at;
  }
  Vec3 tick() {
    sample.position_m = reading();
    sent_N.push_back(answer.tick(sample, true, kTick_s));
    const int at = int(sent_N.size()) - 1 - delay;
    const Vec3 force_N = at >= 0 ? sent_N[std::size_t(at)] * motor : Vec3(0.0);
    hand_m.x += drift_m_s * kTick_s;
    constexpr int kSub = 20;
    for (int n = 0; n < kSub; ++n) {
      Vec3 rub(0.0);
      for (int i = 0; i < 3; ++i) rub[i] = friction_N * std::tanh(v_m_s[i] / 0.005);
      v_m_s += (kTick_s / kSub) / mass_kg *
               (force_N + hand_N_per_m * (hand_m - x_m) - hand_Ns_per_m * v_m_s - rub);
      x_m += (kTick_s / kSub) * v_m_s;
    }
    farthest_m = std::max(farthest_m, glm::length(x_m - hand_m));
    return sent_N.back();
  }
  // Asked, taken by the button, until it is over.
  const ArmAnswer& run() {
    answer.ask(0.045, kTick_s * delay, 0.88, 10.0, step_m);
    tick();
    sample.button = true;
    for (int n = 0; n < 6000 && ArmAnswer::runs(answer.phase()); ++n) tick();
    return answer;
  }
  double least() const { return *std::ranges::min_element(answer.shares()); }
};

TEST(ArmAnswer, AnArmThatIsWellGoesWhereItIsPushedInAnyHand) {
  for (const double hand : {0.0, 100.0, 300.0, 1000.0}) {
    for (const double step : {0.0, 5.5e-5}) {
      for (const double drift : {0.0, 0.08}) {
        for (const int delay : {0, 3}) {
          Plant arm;
          arm.hand_N_per_m = hand;
          arm.step_m = step;
          arm.drift_m_s = hand > 0.0 ? drift : 0.0;
          arm.delay = delay;
          ASSERT_EQ(arm.run().phase(), Phase::done);
          ASSERT_TRUE(arm.answer.pushed());
          EXPECT_GT(arm.least(), 0.2) << hand << " N/m, step " << step << ", drift " << drift;
          EXPECT_LT(*std::ranges::max_element(arm.answer.shares()), 1.5);
          EXPECT_LE(arm.answer.noise_m(), step + 1e-6);
          EXPECT_LT(arm.farthest_m, 0.008);
        }
      }
    }
  }
  Plant free;
  free.hand_N_per_m = free.hand_Ns_per_m = 0.0;
  free.step_m = 0.0;
  free.run();
  for (const double share : free.answer.shares()) EXPECT_NEAR(share, 1.0, 0.01);
}

TEST(ArmAnswer, AnEncoderThatCountsTheWrongWayIsBelowNothing) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double hand : {30.0, 300.0, 1000.0}) {
      Plant arm;
      arm.hand_N_per_m = hand;
      arm.drift_m_s = 0.05;
      arm.encoder[axis] = -1.0;
      ASSERT_EQ(arm.run().phase(), Phase::done);
      EXPECT_LT(arm.least(), -0.15);
      EXPECT_EQ(std::ranges::min_element(arm.answer.shares()) - arm.answer.shares().begin(), axis);
    }
  }
}

TEST(ArmAnswer, AMotorThatIsCutOffAnswersNothing) {
  Plant arm;
  arm.motor = Vec3(1.0, 0.0, 1.0);
  ASSERT_EQ(arm.run().phase(), Phase::done);
  EXPECT_NEAR(arm.answer.shares()[1], 0.0, 0.05);
  EXPECT_GT(arm.answer.shares()[0], 0.2);
  Plant rubs;  // as an Omni does
  rubs.friction_N = 0.26;
  EXPECT_EQ(rubs.run().phase(), Phase::done);
  EXPECT_GT(rubs.least(), 0.15);
}

TEST(ArmAnswer, SamplesThatScatterAreSeenAndThoseThatSayNothingAreNotPushed) {
  Plant arm;
  arm.scatter_m = 2e-4;
  arm.run();
  EXPECT_NEAR(arm.answer.noise_m(), 2e-4, 3e-5);
  Plant bad;
  bad.scatter_m = 3e-3;
  EXPECT_EQ(bad.run().phase(), Phase::done);
  EXPECT_GT(bad.answer.noise_m(), 2e-3);
  EXPECT_FALSE(bad.answer.pushed());
  for (const Vec3& force : bad.sent_N) EXPECT_EQ(force, Vec3(0.0));
}

TEST(ArmAnswer, WithoutAHandThereIsNoForce) {
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
}

TEST(ArmAnswer, WhoLetsGoOfTheButtonOrTheArmHasNoForceInThatTick) {
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

TEST(ArmAnswer, NeverPushesMoreThanItsBoundNorAlongTwoAxes) {
  Plant arm;
  arm.run();
  for (const Vec3& force : arm.sent_N) {
    ASSERT_LE(glm::length(force), 0.8);
    ASSERT_LE((force.x != 0.0) + (force.y != 0.0) + (force.z != 0.0), 1);
  }
  EXPECT_LT(arm.sent_N.size(), 2500u);
}

}  // namespace
}  // namespace trephine
