// The geometry of two eyes before a screen: parallax, its sign, and nothing up or down.
#include "headset/stereo_screen.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

// Where an eye's picture shows a point of the head's frame, of its width and height.
glm::dvec2 seenAt(const EyeView& eye, const Vec3& point) {
  const Vec3 at = glm::conjugate(eye.pose.orientation) * (point - eye.pose.position);
  const FieldOfView& of = eye.sees;
  return {(at.x / -at.z - of.left) / (of.right - of.left),
          (at.y / -at.z - of.down) / (of.up - of.down)};
}

TEST(StereoScreen, WhatIsAtTheScreenHasNoParallaxWhatIsBeforeItCrossesWhatIsBehindItDoesNot) {
  const StereoScreen screen;
  for (const Vec3& head : {Vec3(0.0), Vec3(30.0, -40.0, 500.0)}) {
    const Pose pose{head, glm::angleAxis(0.4, glm::normalize(Vec3(1, 2, 3)))};
    const Eyes eyes = eyesBefore(screen, pose);
    for (const double depth : {150.0, 300.0, 600.0, 1200.0, 1e6}) {
      for (const Vec3& beside : {Vec3(0.0), Vec3(40.0, -70.0, 0.0)}) {
        const Vec3 point = pose.position + pose.orientation * (beside + Vec3(0.0, 0.0, -depth));
        const glm::dvec2 left = seenAt(eyes[0], point), right = seenAt(eyes[1], point);
        EXPECT_NEAR(left.y, right.y, 1e-12) << "nothing up or down";
        EXPECT_NEAR(right.x - left.x, parallaxAt(screen, depth), 1e-9) << depth;
        if (depth < 600.0) {
          EXPECT_LT(right.x, left.x) << "before the screen";
        }
        if (depth > 600.0) {
          EXPECT_GT(right.x, left.x) << "behind it";
        }
      }
    }
  }
  EXPECT_EQ(parallaxAt(screen, screen.distance), 0.0);
  // The farthest is seen as far apart as the eyes are: they never have to diverge.
  EXPECT_NEAR(parallaxAt(screen, 1e12) * screen.height * screen.aspect, screen.separation, 1e-6);
}

TEST(StereoScreen, BothPicturesFillTheScreenWithoutAGap) {
  for (const auto& [width, height] : {std::pair(1920, 1080), std::pair(1281, 721)}) {
    for (const Packing packing : {Packing::full, Packing::half}) {
      const EyeRect left = rectOf(0, packing, width, height);
      const EyeRect right = rectOf(1, packing, width, height);
      EXPECT_EQ(left.x, 0);
      EXPECT_EQ(left.x + left.width, right.x);
      EXPECT_EQ(right.x + right.width, width);
      EXPECT_EQ(left.height, height);
      EXPECT_EQ(right.height, height);
    }
    const EyeRect above = rectOf(0, Packing::top_bottom, width, height);
    const EyeRect below = rectOf(1, Packing::top_bottom, width, height);
    EXPECT_EQ(below.y, 0);
    EXPECT_EQ(below.y + below.height, above.y);
    EXPECT_EQ(above.y + above.height, height);
    EXPECT_EQ(above.width, width);
  }
  EXPECT_DOUBLE_EQ(aspectOf(Packing::full, 3840, 1080), 16.0 / 9.0);
  EXPECT_DOUBLE_EQ(aspectOf(Packing::half, 1920, 1080), 16.0 / 9.0);
  EXPECT_DOUBLE_EQ(aspectOf(Packing::top_bottom, 1920, 1080), 16.0 / 9.0);
}

}  // namespace
}  // namespace trephine
