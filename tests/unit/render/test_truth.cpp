// What the ray caster says that VTK's own does not: surfaces, classes, labels, ghosts, clipped
// faces, and the light, read from pixels.
#include <algorithm>
#include <vector>

#include "machine/common/sphere_normals.h"
#include "scenes.h"

using namespace trephine;
using namespace trephine::test;

namespace {

constexpr double kEye_mm = 400.0;

std::array<int, 3> pixel(const Picture& picture, int x, int y) {
  const std::uint8_t* rgb =
      picture.rgb.data() + 3 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x));
  return {rgb[0], rgb[1], rgb[2]};
}
std::array<int, 3> middleOf(const Picture& picture) {
  return pixel(picture, picture.width / 2, picture.height / 2);
}
int brightness(const std::array<int, 3>& rgb) {
  return rgb[0] + rgb[1] + rgb[2];
}

// The median angle between the picture's normals of a sphere and the sphere's own.
double medianNormalError_deg(SceneRenderer& renderer, double radius_mm, bool hollow = false) {
  UploadProbe::setNormalsAsColour(renderer, true);
  const Picture picture = renderer.picture();
  UploadProbe::setNormalsAsColour(renderer, false);
  std::vector<double> errors;
  for (const SphereNormal& normal : sphereNormals(picture, renderer, radius_mm, hollow)) {
    errors.push_back(error_deg(normal));
  }
  std::ranges::sort(errors);
  return errors.empty() ? 180.0 : errors[errors.size() / 2];
}

// HU of a place by its distance from the origin, with noise of 10 HU.
template <class Hu>
Volume round(const Hu& hu) {
  Volume volume = ball();
  for (std::size_t i = 0; i < volume.hu.size(); ++i) {
    const Index3 v = volume.geometry.indicesOf(i);
    const double r = glm::length(volume.geometry.toPatient_mm(Vec3(v[0], v[1], v[2])));
    const double noise = double((i * 2654435761u >> 8) % 35) - 17.0;
    volume.hu[i] = std::int16_t(hu(r) + noise);
  }
  return volume;
}
double edge(double r, double at) {  // 1 inside, 0 outside, a voxel wide
  return std::clamp(at - r + 0.5, 0.0, 1.0);
}

TEST(Truth, NormalsFollowASphereMoreCloselyThanCentralDifferences) {
  RENDERER_OR_SKIP(renderer);
  renderer.setTissues(tissues());
  renderer.setVolume(Grid(round([](double r) { return -1000.0 + 2200.0 * edge(r, 24.0); })));
  renderer.lookAt(Vec3(0.0), Vec3(0.5, 0.7, -0.4), Vec3(0, 0, 1), kEye_mm);
  const double ours = medianNormalError_deg(renderer, 24.0);
  renderer.setShading({false, false});
  const double differences = medianNormalError_deg(renderer, 24.0);
  EXPECT_LT(ours, 2.5);
  EXPECT_GT(differences, 1.25 * ours);
}

TEST(Truth, TheWallOfACutIsShadedByItsOwnShapeAtOnce) {
  RENDERER_OR_SKIP(renderer);
  renderer.setTissues(tissues());
  Volume block = ball();
  std::ranges::fill(block.hu, std::int16_t(1200));
  Grid grid(std::move(block));
  renderer.setVolume(grid);
  renderer.lookAt(Vec3(0.0), Vec3(0.0, 1.0, 0.0), Vec3(0, 0, 1), kEye_mm);
  renderer.picture();
  carve(grid, Vec3(0.0), 21.0);
  // A way in from the front, so that the hollow is seen.
  for (int step = 0; step < 4; ++step) carve(grid, Vec3(0.0, -20.0 - 4.0 * step, 0.0), 21.0);
  ASSERT_TRUE(renderer.pullChanges(grid));
  EXPECT_LT(medianNormalError_deg(renderer, 21.0, true), 6.0) << "voxels make steps of 45 degrees";
}

// Bone in air passes all HU between; soft tissue lies nowhere.
TEST(Truth, AnEdgeBetweenBoneAndAirShowsNoSoftTissue) {
  RENDERER_OR_SKIP(renderer);
  TissueSet set = tissues(0.4, 0.9);
  set.tissues[0].colour = Vec3(0, 1, 0);
  set.tissues[1].colour = Vec3(1, 0, 0);
  renderer.setTissues(set);
  renderer.setVolume(Grid(round([](double r) { return -1000.0 + 2200.0 * edge(r, 24.0); })));
  UploadProbe::setFirstTissue(renderer, true);
  const auto count = [&] {
    const Picture picture = renderer.picture();
    std::array<int, 2> soft_and_bone{};
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        const auto rgb = pixel(picture, x, y);
        soft_and_bone[0] += rgb[1] > 200 && rgb[0] < 50;
        soft_and_bone[1] += rgb[0] > 200 && rgb[1] < 50;
      }
    }
    return soft_and_bone;
  };
  const auto [soft, bone] = count();
  EXPECT_GT(bone, 2000);
  EXPECT_LT(soft, bone / 50);
  renderer.setShading({true, false});
  EXPECT_GT(count()[0], bone / 2) << "by HU alone a skin of soft tissue lies around it";
}

TEST(Truth, SoftTissueThatIsThereIsShownBesideBone) {
  RENDERER_OR_SKIP(renderer);
  TissueSet set = tissues(0.4, 0.9);
  set.tissues[0].colour = Vec3(0, 1, 0);
  renderer.setTissues(set);
  renderer.setVolume(Grid(
      round([](double r) { return -1000.0 + 1040.0 * edge(r, 24.0) + 1160.0 * edge(r, 16.0); })));
  UploadProbe::setFirstTissue(renderer, true);
  const auto rgb = middleOf(renderer.picture());
  EXPECT_GT(rgb[1], 200);
  EXPECT_LT(rgb[0], 50);
}

TEST(Truth, ALabelsBorderIsASmoothSurfaceWhereHuDoNotChange) {
  RENDERER_OR_SKIP(renderer);
  Volume even = round([](double) { return 50.0; });
  LabelMap map{even.geometry, std::vector<std::uint8_t>(even.hu.size())};
  for (std::size_t i = 0; i < map.labels.size(); ++i) {
    const Index3 v = map.geometry.indicesOf(i);
    const double r = glm::length(map.geometry.toPatient_mm(Vec3(v[0], v[1], v[2])));
    map.labels[i] = r < 22.0 ? 3 : 0;
  }
  Tissue organ = tissue("organ", -200, 3000, Vec3(0.6, 0.2, 0.2), 0.9);
  organ.label = 3;
  renderer.setTissues({"organ", {organ}});
  renderer.setVolume(Grid(std::move(even), std::make_shared<const LabelMap>(std::move(map))));
  renderer.lookAt(Vec3(0.0), Vec3(0.4, 0.8, -0.3), Vec3(0, 0, 1), kEye_mm);
  EXPECT_LT(medianNormalError_deg(renderer, 22.0), 6.0) << "voxels make steps of 45 degrees";
}

TEST(Truth, AGhostLetsWhatLiesBehindItBeSeenAndKeepsItsOutline) {
  RENDERER_OR_SKIP(renderer);
  // Bone around a core of soft tissue.
  const Grid grid(round([](double r) {
    return -1000.0 + 2200.0 * edge(r, 26.0) - 2200.0 * edge(r, 21.0) + 1050.0 * edge(r, 12.0);
  }));
  TissueSet set = tissues(0.9, 0.9);
  set.tissues[0].colour = Vec3(0, 1, 0);
  renderer.setVolume(grid);
  renderer.setTissues(set, {{"bone", TissueLook::hidden}, {"soft", TissueLook::hidden}});
  const Picture nothing = renderer.picture();
  renderer.setTissues(set, {{"bone", TissueLook::ghosted}});
  const Picture ghost = renderer.picture();
  const auto seen = middleOf(ghost);
  EXPECT_GT(seen[1], 2 * seen[0]) << "green behind the ghost";
  // Along a row, the ghost's rim is stronger than the rest of it.
  int rim = 0, beside_core = 0;
  const double mm = renderer.mmPerPixelAt(Vec3(0.0));
  for (int x = 0; x < kWidth; ++x) {
    const double from_middle = std::abs(x + 0.5 - kWidth / 2.0) * mm;
    const int change = std::abs(brightness(pixel(ghost, x, kHeight / 2)) -
                                brightness(pixel(nothing, x, kHeight / 2)));
    if (from_middle > 23.0 && from_middle < 27.5) rim = std::max(rim, change);
    if (from_middle > 14.0 && from_middle < 18.0) beside_core = std::max(beside_core, change);
  }
  EXPECT_GT(2 * rim, 3 * beside_core);
  EXPECT_GT(beside_core, 0) << "it is not gone";
}

TEST(Truth, AClipPlaneTakesAwayItsSideAndShowsAFaceWhereItCuts) {
  RENDERER_OR_SKIP(renderer);
  renderer.setTissues(tissues());
  renderer.setVolume(Grid(round([](double r) { return -1000.0 + 2200.0 * edge(r, 24.0); })));
  renderer.lookAt(Vec3(0.0), Vec3(0.0, 1.0, 0.0), Vec3(0, 0, 1), kEye_mm);
  const Picture whole = renderer.picture();
  // What is the patient's left, x > 0, and at the picture's right.
  renderer.setClip({{Vec3(0.0), Vec3(1, 0, 0)}});
  const Difference gone = difference(whole, renderer.picture());
  EXPECT_GT(gone.pixels, 500);
  EXPECT_GT(gone.centre.x, kWidth / 2.0 + 5.0);
  // What lies towards the eye: a flat face, whose normal is the plane's.
  renderer.setClip({{Vec3(0.0), Vec3(0, -1, 0)}});
  UploadProbe::setNormalsAsColour(renderer, true);
  const Picture face = renderer.picture();
  for (const int x : {kWidth / 2 - 15, kWidth / 2, kWidth / 2 + 15}) {
    const auto rgb = pixel(face, x, kHeight / 2);
    EXPECT_NEAR(rgb[0], 127, 4);
    EXPECT_NEAR(rgb[1], 127, 4);
    EXPECT_GT(rgb[2], 250);
  }
  UploadProbe::setNormalsAsColour(renderer, false);
  renderer.setClip({});
  EXPECT_EQ(renderer.picture(), whole);
}

TEST(Truth, APlaneAlongTheRaysTakesAwayItsSideToo) {
  RENDERER_OR_SKIP(renderer);
  renderer.setTissues(tissues());
  renderer.setVolume(Grid(round([](double r) { return -1000.0 + 2200.0 * edge(r, 24.0); })));
  // Orthographic and along an axis, no ray crosses the plane.
  renderer.resetCamera(Vec3(0, 1, 0), Vec3(0, 0, 1));
  renderer.setParallel(true);
  const Picture whole = renderer.picture();
  for (const double side : {1.0, -1.0}) {
    renderer.setClip({{Vec3(0.0), Vec3(side, 0, 0)}});
    const Difference gone = difference(whole, renderer.picture());
    EXPECT_GT(gone.pixels, 500);
    EXPECT_GT(side * (gone.centre.x - kWidth / 2.0), 5.0);
  }
}

TEST(Truth, APlaneThatLeavesNothingLeavesTheBackground) {
  RENDERER_OR_SKIP(renderer);
  renderer.setTissues(tissues(0.0, 0.0));
  renderer.setVolume(Grid(ball()));
  const Picture nothing = renderer.picture();
  renderer.setTissues(tissues());
  renderer.setClip({{Vec3(0.0, 0.0, -500.0), Vec3(0, 0, 1)}});
  EXPECT_EQ(difference(nothing, renderer.picture()).pixels, 0);
}

TEST(Truth, TheLightComesFromWhereItIsPutAndTurnsWithTheEye) {
  RENDERER_OR_SKIP(renderer);
  renderer.setTissues(tissues());
  renderer.setVolume(Grid(round([](double r) { return -1000.0 + 2200.0 * edge(r, 24.0); })));
  renderer.setLight(Vec3(1.0, 0.0, 0.5));
  for (const Vec3& way : {Vec3(0, 1, 0), Vec3(-0.8, 0.3, 0.2)}) {
    renderer.lookAt(Vec3(0.0), way, Vec3(0, 0, 1), kEye_mm);
    const Picture picture = renderer.picture();
    const int aside = int(16.0 / renderer.mmPerPixelAt(Vec3(0.0)));
    const int right = brightness(pixel(picture, kWidth / 2 + aside, kHeight / 2));
    const int left = brightness(pixel(picture, kWidth / 2 - aside, kHeight / 2));
    EXPECT_GT(right, left + 100);
  }
}

TEST(Truth, AtFirstTheLightComesFromTheUpperLeftSoThatAHollowHasALitAndADarkWall) {
  RENDERER_OR_SKIP(renderer);
  renderer.setTissues(tissues());
  renderer.setVolume(Grid(round([](double r) { return -1000.0 + 2200.0 * edge(r, 24.0); })));
  renderer.lookAt(Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 0, 1), kEye_mm);
  const Picture picture = renderer.picture();
  const int aside = int(13.0 / renderer.mmPerPixelAt(Vec3(0.0)));
  const auto at = [&](int right, int down) {
    return brightness(pixel(picture, kWidth / 2 + right * aside, kHeight / 2 + down * aside));
  };
  EXPECT_GT(at(-1, 0), at(1, 0) + 40);
  EXPECT_GT(at(0, -1), at(0, 1) + 40);
  EXPECT_GT(at(1, 1), 100) << "nothing is black";
  renderer.setLight(SceneRenderer::kLight);
  EXPECT_EQ(renderer.picture(), picture);
}

TEST(Truth, ABadLightIsNoLight) {
  RENDERER_OR_SKIP(renderer);
  renderer.setTissues(tissues());
  renderer.setVolume(Grid(ball()));
  const Picture before = renderer.picture();
  renderer.setLight(Vec3(0.0));
  renderer.setLight(Vec3(std::nan(""), 0.0, 1.0));
  EXPECT_EQ(renderer.picture(), before);
}

}  // namespace
