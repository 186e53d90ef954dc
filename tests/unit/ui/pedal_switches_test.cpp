#include "ui/train/pedal_switches.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

using Asked = PedalSwitches::Asked;

bool nothing(const Asked& asked) {
  return !asked.recentre && !asked.back && !asked.clutch;
}

TEST(PedalSwitchesTest, TheLeftOneAloneGoesBackOnceItIsUpAgain) {
  PedalSwitches pedal;
  EXPECT_TRUE(nothing(pedal.follow(kPedalLeft)));
  EXPECT_TRUE(nothing(pedal.follow(kPedalLeft)));
  EXPECT_TRUE(pedal.follow(0).back);
  EXPECT_TRUE(nothing(pedal.follow(0)));
}

TEST(PedalSwitchesTest, TheRightOneAloneIsTheClutchWhileItIsDown) {
  PedalSwitches pedal;
  EXPECT_EQ(pedal.follow(kPedalRight).clutch, true);
  EXPECT_TRUE(nothing(pedal.follow(kPedalRight)));
  EXPECT_EQ(pedal.follow(0).clutch, false);
}

TEST(PedalSwitchesTest, BothAtOnceBringThePatientBeforeTheWearerOnceAndNothingElse) {
  PedalSwitches pedal;
  const Asked asked = pedal.follow(kPedalLeft | kPedalRight);
  EXPECT_TRUE(asked.recentre);
  EXPECT_FALSE(asked.clutch || asked.back);
  EXPECT_TRUE(nothing(pedal.follow(kPedalLeft | kPedalRight)));
  EXPECT_TRUE(nothing(pedal.follow(kPedalRight)));  // the left one up first: no way back,
  EXPECT_TRUE(nothing(pedal.follow(0)));            // and hands were never let go of
}

TEST(PedalSwitchesTest, FeetAreNeverDownAtTheSameMoment) {
  PedalSwitches left_first;
  EXPECT_TRUE(nothing(left_first.follow(kPedalLeft)));
  const Asked both = left_first.follow(kPedalLeft | kPedalRight);
  EXPECT_TRUE(both.recentre && !both.clutch);
  EXPECT_TRUE(nothing(left_first.follow(kPedalLeft)));
  EXPECT_TRUE(nothing(left_first.follow(0)));

  PedalSwitches right_first;
  EXPECT_EQ(right_first.follow(kPedalRight).clutch, true);
  EXPECT_TRUE(right_first.follow(kPedalLeft | kPedalRight).recentre);
  EXPECT_EQ(right_first.follow(kPedalLeft).clutch, false);
  EXPECT_TRUE(nothing(right_first.follow(0)));
}

TEST(PedalSwitchesTest, AfterBothTheyAreWhatTheyWere) {
  PedalSwitches pedal;
  pedal.follow(kPedalLeft | kPedalRight);
  pedal.follow(0);
  EXPECT_TRUE(nothing(pedal.follow(kPedalLeft)));
  EXPECT_TRUE(pedal.follow(0).back);
  EXPECT_EQ(pedal.follow(kPedalRight).clutch, true);
}

TEST(PedalSwitchesTest, TheMiddleOneAndAnArmsOwnButtonsAskForNothing) {
  PedalSwitches pedal;
  EXPECT_TRUE(nothing(pedal.follow(kPedalMiddle | kPedalThere | 3U)));
  EXPECT_TRUE(nothing(pedal.follow(0)));
}

}  // namespace
}  // namespace trephine
