#include "haptics/rest_hold.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace trephine {
namespace {

constexpr double kT = 0.001, kStep_m = 0.055e-3, kStiffness = 900.0;

// A light push along z, and an arm that flickers by a count along x and y.
struct Light {
  RestHold rest{kStep_m, kT};
  Vec3 low_N{1e9}, high_N{-1e9};

  void run(int ticks, double push_N, int counts, double creep_m = 0.0) {
    low_N = Vec3(1e9);
    high_N = Vec3(-1e9);
    for (int i = 0; i < ticks; ++i) {
      const Vec3 at_m(creep_m * i + counts * kStep_m * ((i / 7) % 2),
                      counts * kStep_m * ((i / 11) % 2), 0.0);
      const Vec3 elastic_N = Vec3(0.0, 0.0, push_N) - kStiffness * at_m;
      const Vec3 sent_N = rest.hold(elastic_N, kStiffness, at_m, elastic_N);
      low_N = glm::min(low_N, sent_N);
      high_N = glm::max(high_N, sent_N);
    }
  }
};

TEST(RestHold, HoldsALightPushThatACountAcrossItTurns) {
  // A count of 0.05 N across a push of 0.15 N turns it by 18 degrees.
  Light light;
  light.run(500, 0.15, 1);
  light.run(500, 0.15, 1);
  EXPECT_EQ(light.low_N, light.high_N);
}

TEST(RestHold, LetsGoOfAForceThatTurnsByMoreThanCountsDo) {
  Light light;
  light.run(500, 0.15, 1);
  light.run(500, 0.15, 3);
  EXPECT_GT(light.high_N.x - light.low_N.x, 0.1);
  EXPECT_GT(light.high_N.y - light.low_N.y, 0.1);
}

TEST(RestHold, HoldsATissueWhoseSlopeIsFirmerThanItsStiffness) {
  // 490 N/m where it is said to be 384: a count changes the push by more than a count's worth.
  const auto swing_N = [](int counts) {
    RestHold rest(kStep_m, kT);
    double low_N = 1e9, high_N = -1e9;
    for (int i = 0; i < 1000; ++i) {
      const Vec3 at_m(0.0, 0.0, -kStep_m * (25 + counts * ((i / 7) % 2)));
      const Vec3 elastic_N(0.0, 0.0, -490.0 * at_m.z);
      const double sent_N = rest.hold(elastic_N, 384.0, at_m, elastic_N).z;
      if (i < 500) continue;
      low_N = std::min(low_N, sent_N);
      high_N = std::max(high_N, sent_N);
    }
    return high_N - low_N;
  };
  EXPECT_EQ(swing_N(1), 0.0);
  EXPECT_GT(swing_N(2), 0.05) << "two counts are a motion";
}

TEST(RestHold, LetsGoWithoutAJumpOfAForceThatWouldBeAnotherByNow) {
  // What is shown of a stiffness comes back while it is held: from half to all of it.
  RestHold rest(kStep_m, kT);
  double last_N = 0.0, most_N = 0.0;
  for (int i = 0; i < 1400; ++i) {
    const Vec3 at_m(0.0, 0.0, -kStep_m * (i < 1000 ? 20 : 22));
    const double shown = i < 500 ? 0.5 : 1.0;
    const Vec3 elastic_N = -kStiffness * at_m;
    const double sent_N = rest.hold(elastic_N, kStiffness, at_m, shown * elastic_N).z;
    if (i == 999) {
      EXPECT_NEAR(sent_N, 0.5 * elastic_N.z, 1e-9);
    }
    if (i >= 1000) most_N = std::max(most_N, sent_N - last_N);
    if (i == 1399) {
      EXPECT_NEAR(sent_N, elastic_N.z, 1e-6);
    }
    last_N = sent_N;
  }
  EXPECT_LT(most_N, 2.0 * kStiffness * kStep_m);
}

TEST(RestHold, FollowsAToolThatSlides) {
  Light light;
  light.run(500, 3.0, 0);
  light.run(500, 3.0, 0, 1e-6);
  EXPECT_GT(light.high_N.x - light.low_N.x, 0.3);
}

}  // namespace
}  // namespace trephine
