#include "session/soft_watch.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

bool looked(SoftWatch& watch, double learnt_scale, double now_s) {
  ArmRecord arm;
  arm.learnt_scale = learnt_scale;
  return watch.look(arm, now_s);
}

TEST(SoftWatch, TellsOfAScaleThatStaysLowForASecond) {
  SoftWatch watch;
  EXPECT_FALSE(looked(watch, 0.15, 10.0));
  EXPECT_FALSE(looked(watch, 0.15, 10.9));
  EXPECT_TRUE(looked(watch, 0.1, 11.0));
  EXPECT_FALSE(looked(watch, 0.25, 11.1)) << "it came back";
  EXPECT_FALSE(looked(watch, 0.15, 11.2)) << "a second from now on";
}

TEST(SoftWatch, KnowsNothingOfOtherControllers) {
  SoftWatch watch;
  for (double t = 0.0; t < 5.0; t += 0.5) EXPECT_FALSE(looked(watch, 0.0, t));
}

}  // namespace
}  // namespace trephine
