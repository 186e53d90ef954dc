// When a hand is on an arm, and when it has let go.
#include "session/hand_on_arm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace trephine {
namespace {

constexpr double kPeriod_s = 1e-3;

HandSample sampleAt(double x_m, bool button = false, bool no_hand = false) {
  return {Vec3(x_m, 0.0, 0.0), button, no_hand, false};
}

// Whether a hand has taken an arm that goes there at this speed, and then lies for a while.
struct ArmThatLay {
  HandOnArm hand;
  double x_m = 0.0;

  bool taken(double to_m, double speed_m_s, bool no_hand = false) {
    const int ticks = std::max(1, int(std::lround(std::abs(to_m - x_m) / speed_m_s / kPeriod_s)));
    const double step_m = (to_m - x_m) / ticks;
    bool taken = false;
    for (int i = 0; i < ticks + 1200; ++i) {
      if (i < ticks) x_m += step_m;
      taken = taken || hand.takes(sampleAt(x_m, false, no_hand), kPeriod_s);
    }
    return taken;
  }
};

TEST(HandOnArm, AButtonIsAHandForAsLongAsItIsHeld) {
  HandOnArm hand;
  EXPECT_FALSE(hand.takes(sampleAt(0.0), kPeriod_s));
  EXPECT_TRUE(hand.takes(sampleAt(0.0, true), kPeriod_s));
  EXPECT_FALSE(hand.letsGo(sampleAt(0.1, true)));
  EXPECT_TRUE(hand.letsGo(sampleAt(0.1)));
}

TEST(HandOnArm, AnArmThatIsMovedHasAHandUntilItSaysThatItHasNone) {
  ArmThatLay arm;
  EXPECT_FALSE(arm.taken(0.0, 0.1));
  EXPECT_FALSE(arm.taken(0.0049, 0.1));
  EXPECT_TRUE(arm.taken(0.0055, 0.1));
  EXPECT_FALSE(arm.hand.letsGo(sampleAt(0.0)));
  EXPECT_TRUE(arm.hand.letsGo(sampleAt(0.0, false, true)));
}

TEST(HandOnArm, AJumpOfAnEncoderThatComesBackIsNoHand) {
  HandOnArm hand;
  for (int i = 0; i < 1000; ++i) {
    EXPECT_FALSE(hand.takes(sampleAt(i % 50 < 15 ? 0.02 : 0.0), kPeriod_s));
  }
}

TEST(HandOnArm, AnEncoderThatJumpsForGoodIsNoHand) {
  for (const double jump_m : {0.0051, 0.0065, 0.01, 0.05, 0.2}) {
    ArmThatLay arm;
    EXPECT_FALSE(arm.taken(0.0, 0.1));
    EXPECT_FALSE(arm.taken(jump_m, 1e3)) << jump_m;
    EXPECT_TRUE(arm.taken(jump_m + 0.006, 0.1)) << "moved from there";
  }
}

TEST(HandOnArm, AnArmThatIsStruckAndThenLiesHasNone) {
  for (const auto& [by_m, at_m_s] : {std::pair(0.008, 0.9), {0.012, 1.5}, {0.03, 0.7}}) {
    ArmThatLay arm;
    EXPECT_FALSE(arm.taken(0.0, 0.1));
    EXPECT_FALSE(arm.taken(by_m, at_m_s)) << by_m;
  }
}

TEST(HandOnArm, AnArmThatIsStruckAndCoastsHasNoneUntilItIsMovedFromWhereItRests) {
  for (const double from_m_s : {1.0, 1.5, 3.0}) {
    for (const double slowed_m_s2 : {0.2, 1.0, 2.0, 5.0, 9.8, 20.0}) {
      ArmThatLay arm;
      EXPECT_FALSE(arm.taken(0.0, 0.1));
      for (double speed_m_s = from_m_s; speed_m_s > 0.0; speed_m_s -= slowed_m_s2 * kPeriod_s) {
        arm.x_m += speed_m_s * kPeriod_s;
        EXPECT_FALSE(arm.hand.takes(sampleAt(arm.x_m), kPeriod_s))
            << from_m_s << " " << slowed_m_s2;
      }
      EXPECT_FALSE(arm.taken(arm.x_m, 0.1)) << from_m_s << " " << slowed_m_s2;
      EXPECT_TRUE(arm.taken(arm.x_m + 0.006, 0.1));
    }
  }
}

// What hangs free swings to and fro: where it turns it does not rest.
TEST(HandOnArm, AnArmThatIsStruckAndSwingsHasNone) {
  for (const double at_hz : {1.0, 2.0, 3.0}) {
    for (const double damping : {0.05, 0.1, 0.4}) {
      for (const double by_m_s : {0.8, 1.0, 2.0}) {
        ArmThatLay arm;
        EXPECT_FALSE(arm.taken(0.0, 0.1));
        const double w = 2.0 * 3.14159265358979 * at_hz;
        double speed_m_s = by_m_s;
        bool taken = false;
        for (int i = 0; i < 20000; ++i) {
          speed_m_s += kPeriod_s * (-w * w * arm.x_m - 2.0 * damping * w * speed_m_s);
          arm.x_m += kPeriod_s * speed_m_s;
          const double seen_m = 55e-6 * std::round(arm.x_m / 55e-6);
          taken = taken || arm.hand.takes(sampleAt(seen_m), kPeriod_s);
        }
        EXPECT_FALSE(taken) << at_hz << " Hz, " << damping << ", " << by_m_s;
        EXPECT_TRUE(arm.taken(arm.x_m + 0.01, 0.1));
      }
    }
  }
}

TEST(HandOnArm, AnArmThatIsStruckAgainstItsEndHasNone) {
  for (const double by_m_s : {1.0, 1.5}) {
    for (const double back : {0.1, 0.2, 0.3, 0.5}) {
      ArmThatLay arm;
      EXPECT_FALSE(arm.taken(0.0, 0.1));
      double speed_m_s = by_m_s;
      bool taken = false;
      for (int i = 0; i < 3000; ++i) {
        arm.x_m += kPeriod_s * speed_m_s;
        if (arm.x_m > 0.08) speed_m_s *= -back;
        speed_m_s -= std::clamp(speed_m_s, -kPeriod_s, kPeriod_s);  // 1 m/s^2 of friction
        taken = taken || arm.hand.takes(sampleAt(arm.x_m), kPeriod_s);
      }
      EXPECT_FALSE(taken) << by_m_s << " " << back;
    }
  }
}

TEST(HandOnArm, AHandThatReachesAtASurgeonsPaceIsTakenAsItGoes) {
  for (const double way_s : {0.5, 1.0, 2.0}) {
    ArmThatLay arm;
    EXPECT_FALSE(arm.taken(0.0, 0.1));
    bool taken = false;
    for (double t = 0.0; t < 1.0; t += kPeriod_s / way_s) {  // 10 cm, of least jerk
      const double to_m = 0.1 * t * t * t * (10.0 + t * (6.0 * t - 15.0));
      const double tremor_m = 0.0004 * std::sin(2.0 * 3.14159265358979 * 9.0 * t * way_s);
      arm.x_m = 55e-6 * std::round((to_m + tremor_m) / 55e-6);
      taken = taken || arm.hand.takes(sampleAt(arm.x_m), kPeriod_s);
    }
    EXPECT_TRUE(taken) << way_s;
  }
}

TEST(HandOnArm, AnArmInItsHolderIsMovedFromWhereItLeavesIt) {
  ArmThatLay arm;
  EXPECT_FALSE(arm.taken(0.1, 0.1, true));
  EXPECT_FALSE(arm.hand.takes(sampleAt(0.1, true, true), kPeriod_s)) << "whatever its button says";
  EXPECT_FALSE(arm.taken(0.102, 0.1));
  EXPECT_TRUE(arm.taken(0.106, 0.1));
}

}  // namespace
}  // namespace trephine
