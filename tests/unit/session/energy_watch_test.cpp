#include "session/energy_watch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "haptics/bounded_controller.h"

namespace trephine {
namespace {

// An arm whose record is looked at as often as a window does.
class Watched {
 public:
  ArmRecord arm;
  bool paused = false;

  // Over `seconds` the arm gives out `given_J` and the springs come to hold `stored_J` more.
  // Whether that was ever a fault.
  bool in(double seconds, double given_J, double stored_J = 0.0) {
    bool fault = false;
    const int looks = std::max(1, int(seconds / kEvery_s));
    for (int i = 0; i < looks; ++i) {
      arm.energy_out_J.z += given_J / looks;
      arm.stored_J += stored_J / looks;
      now_s_ += seconds / looks;
      fault = watch_.look(arm, 1.0, paused, now_s_) || fault;
    }
    return fault;
  }

 private:
  static constexpr double kEvery_s = 0.066;
  EnergyWatch watch_;
  double now_s_ = 0.0;
};

TEST(EnergyWatch, WhatWasPressedIntoASpringMayComeBack) {
  Watched w;
  EXPECT_FALSE(w.in(1.0, -0.02, 0.02));
  EXPECT_FALSE(w.in(0.5, 0.02, -0.02));
}

TEST(EnergyWatch, TapsOfWhichAnEncoderHidesALittleAreNoFault) {
  Watched w;
  for (int tap = 0; tap < 50; ++tap) {
    EXPECT_FALSE(w.in(0.15, -0.001, 0.001)) << tap;
    EXPECT_FALSE(w.in(0.15, 0.0011, -0.001)) << tap;
  }
  EXPECT_GT(w.arm.energy_out_J.z, 0.0049) << "more than any one of them";
}

TEST(EnergyWatch, AnArmThatShakesIsAFaultHoweverMuchWasCutBefore) {
  Watched w;
  EXPECT_FALSE(w.in(30.0, -0.5));
  EXPECT_TRUE(w.in(1.0, 0.02));
  EXPECT_LT(w.arm.energy_out_J.z, -0.4);
}

TEST(EnergyWatch, AFaultThatEndedIsForgottenWithinSeconds) {
  Watched w;
  EXPECT_TRUE(w.in(5.0, 0.489));
  w.in(4.0, 0.0);
  EXPECT_FALSE(w.in(1.0, 0.0));
}

TEST(EnergyWatch, WhatComesBackWithTheForceAfterAPauseIsNoFault) {
  Watched w;
  w.in(1.0, -0.005, 0.005);
  w.paused = true;
  EXPECT_FALSE(w.in(1.0, 0.0));
  w.paused = false;
  w.arm.controller_parts = kPartLimiter;
  EXPECT_FALSE(w.in(0.5, 0.01));
  w.arm.controller_parts = 0;
  EXPECT_FALSE(w.in(1.0, 0.0));
  EXPECT_TRUE(w.in(1.0, 0.02)) << "and then it is watched again";
}

TEST(EnergyWatch, ATissueThatIsShownFirmerAgainGivesNothingOutByThat) {
  Watched w;
  w.arm.rendered_share = 0.2;
  w.in(1.0, -0.004, 0.02);
  w.arm.rendered_share = 0.9;
  EXPECT_FALSE(w.in(1.0, 0.0));
}

}  // namespace
}  // namespace trephine
