// The line that a scene draws on the tissue.
#include <cmath>
#include <limits>
#include <numbers>

#include "scenes.h"

using namespace trephine;
using namespace trephine::test;

namespace {

constexpr double kShell_mm = 23.0;  // where the ball's bone begins
constexpr double kRing_mm = 8.0;

// A ring on the bone, towards this side of the ball, so much outside of its surface.
std::vector<Vec3> ringOn(const Vec3& side, double above_mm = 0.0) {
  const Vec3 across = glm::normalize(glm::cross(side, Vec3(0.3, 0.2, 1.0)));
  const Vec3 up = glm::cross(side, across);
  std::vector<Vec3> points;
  for (int i = 0; i < 48; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 48;
    const Vec3 at = kRing_mm * (std::cos(angle) * across + std::sin(angle) * up) +
                    std::sqrt(kShell_mm * kShell_mm - kRing_mm * kRing_mm) * side;
    points.push_back(glm::normalize(at) * (kShell_mm + above_mm));
  }
  return points;
}

const Vec3 kFront(0, -1, 0), kBack(0, 1, 0);

// Of the points of a line, those on which the picture shows its colour: blue over red.
double shareSeen(const Picture& picture, const SceneRenderer& renderer,
                 const std::vector<Vec3>& points) {
  int seen = 0;
  for (const Vec3& p : points) {
    const glm::dvec2 at = glm::round(pixelOf(renderer, Vec3(0.0), p));
    const std::size_t pixel = (std::size_t(at.y) * kWidth + std::size_t(at.x)) * 3;
    seen += int(picture.rgb[pixel + 2]) > int(picture.rgb[pixel]) + 80;
  }
  return double(seen) / double(points.size());
}

void lookAtBall(SceneRenderer& renderer) {
  renderer.setTissues(tissues());
  renderer.setVolume(Grid(ball()));
  renderer.lookAt(Vec3(0.0), kBack, Vec3(0, 0, 1), 120.0);
}

}  // namespace

TEST(Outline, IsSeenAllAlongOnTheSurfaceOnWhichItLies) {
  RENDERER_OR_SKIP(renderer);
  lookAtBall(renderer);
  const Picture none = renderer.picture();
  for (const bool parallel : {false, true}) {
    renderer.setParallel(parallel);
    for (const double above_mm : {-0.5, 0.0, 0.5}) {
      renderer.setOutline(ringOn(kFront, above_mm), true, 1.5);
      EXPECT_GT(shareSeen(renderer.picture(), renderer, ringOn(kFront)), 0.97)
          << above_mm << (parallel ? " parallel" : "");
    }
  }
  renderer.setParallel(false);
  renderer.setOutline({}, true, 1.5);
  EXPECT_EQ(renderer.picture(), none);
}

TEST(Outline, IsHiddenBehindTheTissue) {
  RENDERER_OR_SKIP(renderer);
  lookAtBall(renderer);
  const Picture none = renderer.picture();
  renderer.setOutline(ringOn(kBack), true, 1.5);
  EXPECT_EQ(difference(none, renderer.picture()).pixels, 0);
  renderer.setOutline(ringOn(kFront, -6.0), true, 1.5);  // inside the shell
  EXPECT_EQ(difference(none, renderer.picture()).pixels, 0);
}

TEST(Outline, IsAsWideAsItIsSaidAndHasADarkRim) {
  RENDERER_OR_SKIP(renderer);
  lookAtBall(renderer);
  const Picture none = renderer.picture();
  const std::vector<Vec3> line{Vec3(-10, -30, 0), Vec3(10, -30, 0)};
  const double mm = renderer.mmPerPixelAt(line[0]);
  for (const double width_mm : {2.0, 4.0}) {
    renderer.setOutline(line, false, width_mm);
    const Picture picture = renderer.picture();
    int bright = 0, dark = 0;  // in the column in the middle
    for (int y = 0; y < kHeight; ++y) {
      const std::size_t pixel = (std::size_t(y) * kWidth + kWidth / 2) * 3;
      const int red = picture.rgb[pixel], blue = picture.rgb[pixel + 2];
      const bool drawn = blue > red + 80;
      bright += drawn;
      dark += !drawn && blue + 60 < int(none.rgb[pixel + 2]);
    }
    EXPECT_NEAR(bright, width_mm / mm, 2.0);
    EXPECT_GE(dark, 2);
  }
}

TEST(Outline, IsClosedOnlyWhereItIsSaidToBe) {
  RENDERER_OR_SKIP(renderer);
  lookAtBall(renderer);
  std::vector<Vec3> half = ringOn(kFront);
  half.resize(25);
  const std::vector<Vec3> gap{0.5 * (half.front() + half.back()) - Vec3(0, 4, 0)};
  for (Vec3& p : half) p -= Vec3(0, 4, 0);
  renderer.setOutline(half, false, 1.5);
  EXPECT_EQ(shareSeen(renderer.picture(), renderer, gap), 0.0);
  renderer.setOutline(half, true, 1.5);
  EXPECT_EQ(shareSeen(renderer.picture(), renderer, gap), 1.0);
}

TEST(Outline, CostsNoRayAndStaysWhereAToolInTheTissueIsHidden) {
  RENDERER_OR_SKIP(renderer);
  lookAtBall(renderer);
  const Picture none = renderer.picture();
  renderer.setOutline(ringOn(kFront), true, 1.5);
  EXPECT_TRUE(renderer.complete()) << "the volume's picture is as it was";
  const Picture outlined = renderer.picture();
  EXPECT_GT(difference(none, outlined).pixels, 50);

  ToolView tool;
  tool.shape = ToolShape::blade;
  tool.length_mm = 24.0;
  tool.pose_mm.position = Vec3(0, 0, -12);  // within the shell, behind the ring
  renderer.setTools({tool});
  const Picture hidden = renderer.picture();
  EXPECT_GT(shareSeen(hidden, renderer, ringOn(kFront)), 0.97);

  tool.pose_mm.position = Vec3(0, -40, -12);  // before it
  renderer.setTools({tool});
  EXPECT_LT(shareSeen(renderer.picture(), renderer, ringOn(kFront)), 0.97);
  renderer.setTools({});
  EXPECT_EQ(renderer.picture(), outlined);
}

TEST(Outline, OfNumbersThatCannotBeIsNotDrawn) {
  RENDERER_OR_SKIP(renderer);
  lookAtBall(renderer);
  const Picture none = renderer.picture();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vec3> broken = ringOn(kFront);
  broken[3].x = nan;
  renderer.setOutline(broken, true, 1.5);
  EXPECT_EQ(renderer.picture(), none);
  for (const double width_mm : {0.0, -1.0, nan}) {
    renderer.setOutline(ringOn(kFront), true, width_mm);
    EXPECT_EQ(renderer.picture(), none);
  }
  const Vec3 at(0, -30, 0);
  renderer.setOutline({at, at, at}, true, 1.5);
  EXPECT_EQ(renderer.picture(), none);
  // Two of them at one place in a line that can be drawn.
  renderer.setOutline({at, at, Vec3(8, -30, 0), Vec3(8, -30, 8), at}, true, 1.5);
  EXPECT_GT(difference(none, renderer.picture()).pixels, 20);
}
