#include <gtest/gtest.h>

#include <cmath>

#include "render/scene_renderer.h"

using namespace trephine;

TEST(Camera, OnePixelSpansWhatPerspectiveGives) {
  SceneRenderer renderer;
  renderer.resize(400, 300);
  renderer.lookAt(Vec3(10, 20, 30), Vec3(0, 2, 0), Vec3(0, 0, 5), 200.0);
  const double expected = 2.0 * 200.0 * std::tan(glm::radians(15.0)) / 300.0;
  EXPECT_NEAR(renderer.mmPerPixelAt(Vec3(10, 20, 30)), expected, 1e-9);
  EXPECT_NEAR(renderer.mmPerPixelAt(Vec3(40, -80, 3)), expected / 2.0, 1e-9);
  renderer.zoom(2.0);
  EXPECT_NEAR(renderer.mmPerPixelAt(Vec3(10, 20, 30)), expected / 2.0, 1e-9);
}

TEST(Camera, SeenFromTheFrontThePatientsLeftIsAtTheRight) {
  SceneRenderer renderer;
  renderer.lookAt(Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 0, 1), 200.0);
  EXPECT_NEAR(glm::distance(renderer.viewRight(), Vec3(1, 0, 0)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(renderer.viewUp(), Vec3(0, 0, 1)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(renderer.viewForward(), Vec3(0, 1, 0)), 0.0, 1e-12);
}

TEST(Camera, PanningMovesThePictureWithTheMouse) {
  SceneRenderer renderer;
  renderer.resize(400, 300);
  renderer.lookAt(Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 0, 1), 200.0);
  const double mm = renderer.mmPerPixelAt(Vec3(0.0));
  renderer.pan(10.0, 0.0);
  // What lay at the middle is now 10 pixels right of it: the eye went left by as much.
  renderer.zoom(1.0);
  EXPECT_NEAR(renderer.mmPerPixelAt(Vec3(-10.0 * mm, 0, 0)), mm, 1e-9);
  EXPECT_NEAR(glm::distance(renderer.viewForward(), Vec3(0, 1, 0)), 0.0, 1e-12);
}

TEST(Camera, AFullTurnComesBack) {
  SceneRenderer renderer;
  renderer.lookAt(Vec3(1, 2, 3), Vec3(0.3, 1, -0.2), Vec3(0, 0, 1), 200.0);
  const Vec3 forward = renderer.viewForward(), up = renderer.viewUp();
  for (int i = 0; i < 36; ++i) renderer.orbit(10.0, 0.0);
  EXPECT_NEAR(glm::distance(renderer.viewForward(), forward), 0.0, 1e-9);
  EXPECT_NEAR(glm::distance(renderer.viewUp(), up), 0.0, 1e-9);
  renderer.orbit(std::nan(""), 0.0);
  EXPECT_NEAR(glm::distance(renderer.viewForward(), forward), 0.0, 1e-9);
}

TEST(Camera, LookingAlongTheUpDirectionStillGivesARightHandedView) {
  SceneRenderer renderer;
  renderer.lookAt(Vec3(0.0), Vec3(0, 0, -1), Vec3(0, 0, 1), 200.0);
  EXPECT_NEAR(glm::length(renderer.viewUp()), 1.0, 1e-12);
  EXPECT_NEAR(
      glm::distance(glm::cross(renderer.viewForward(), renderer.viewUp()), renderer.viewRight()),
      0.0, 1e-12);
}
