// When a hand is on an arm, and when it has let go.
#include "session/hand_on_arm.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

HandSample sampleAt(double x_m, bool button = false, bool no_hand = false) {
  return {Vec3(x_m, 0.0, 0.0), button, no_hand, false};
}

TEST(HandOnArm, AButtonIsAHandForAsLongAsItIsHeld) {
  HandOnArm hand;
  EXPECT_FALSE(hand.takes(sampleAt(0.0)));
  EXPECT_TRUE(hand.takes(sampleAt(0.0, true)));
  EXPECT_FALSE(hand.letsGo(sampleAt(0.1, true)));
  EXPECT_TRUE(hand.letsGo(sampleAt(0.1)));
}

TEST(HandOnArm, AnArmThatIsMovedHasAHandUntilItSaysThatItHasNone) {
  HandOnArm hand;
  EXPECT_FALSE(hand.takes(sampleAt(0.2)));
  EXPECT_FALSE(hand.takes(sampleAt(0.2049)));
  EXPECT_TRUE(hand.takes(sampleAt(0.2051)));
  EXPECT_FALSE(hand.letsGo(sampleAt(0.2)));
  EXPECT_TRUE(hand.letsGo(sampleAt(0.2, false, true)));
}

TEST(HandOnArm, AJumpOfAnEncoderIsNoHand) {
  HandOnArm hand(3);
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(hand.takes(sampleAt(0.0)));
    EXPECT_FALSE(hand.takes(sampleAt(0.02)));
    EXPECT_FALSE(hand.takes(sampleAt(0.02)));
  }
  EXPECT_TRUE(hand.takes(sampleAt(0.02)));
}

TEST(HandOnArm, AnArmInItsHolderIsMovedFromWhereItLeavesIt) {
  HandOnArm hand;
  EXPECT_FALSE(hand.takes(sampleAt(0.0)));
  EXPECT_FALSE(hand.takes(sampleAt(0.1, true, true)))
      << "nobody holds it, whatever its button says";
  EXPECT_FALSE(hand.takes(sampleAt(0.1)));
  EXPECT_FALSE(hand.takes(sampleAt(0.102)));
  EXPECT_TRUE(hand.takes(sampleAt(0.106)));
}

}  // namespace
}  // namespace trephine
