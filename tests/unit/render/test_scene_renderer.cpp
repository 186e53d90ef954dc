#include <cstdlib>
#include <glm/gtc/matrix_transform.hpp>
#include <string>

#include "scenes.h"

using namespace trephine;
using namespace trephine::test;

TEST(SceneRenderer, WithoutADisplayItSaysSo) {
  const char* kept = std::getenv("DISPLAY");
  const std::string display = kept ? kept : "";
  ::unsetenv("DISPLAY");
  const auto made = SceneRenderer::offscreen(64, 64);
  if (kept) ::setenv("DISPLAY", display.c_str(), 1);
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().code.str(), "NO_DISPLAY");
}

TEST(SceneRenderer, BeforeItIsAttachedItDrawsNothingAndDoesNotCrash) {
  SceneRenderer renderer;
  renderer.setVolume(Grid(ball()));
  renderer.setTissues(tissues());
  renderer.paint(0);
  EXPECT_TRUE(renderer.picture().rgb.empty());
  EXPECT_EQ(renderer.copy().hu, ball().hu);
}

TEST(SceneRenderer, TheSameStateGivesTheSamePicture) {
  RENDERER_OR_SKIP(renderer);
  const Picture empty = renderer.picture();
  renderer.setVolume(Grid(ball()));
  renderer.setTissues(tissues());
  const Picture first = renderer.picture();
  EXPECT_GT(difference(first, empty).pixels, kWidth * kHeight / 10);
  EXPECT_EQ(renderer.picture(), first);
  renderer.orbit(30, 10);
  EXPECT_NE(renderer.picture(), first);
  renderer.setTissues(tissues(0.5));
  renderer.resetCamera(Vec3(0, 1, 0), Vec3(0, 0, 1));
  EXPECT_NE(renderer.picture(), first);
  renderer.setTissues(tissues());
  EXPECT_EQ(renderer.picture(), first);
}

TEST(SceneRenderer, LeapingOverEmptySpaceChangesNothingVisible) {
  RENDERER_OR_SKIP(renderer);
  renderer.setShading({false, false});
  renderer.setVolume(Grid(ball()));
  for (double soft : {0.0, 0.03, 0.4}) {
    renderer.setTissues(tissues(soft));
    for (const Vec3& direction : {Vec3(0, 1, 0), Vec3(-0.4, 0.7, -0.5), Vec3(0, 0, -1)}) {
      renderer.resetCamera(direction, Vec3(0, -0.3, 1));
      UploadProbe::setLeaping(renderer, false);
      const Picture stock = renderer.picture();
      UploadProbe::setLeaping(renderer, true);
      EXPECT_GE(psnr_dB(stock, renderer.picture()), 60.0) << soft;
    }
  }
}

TEST(SceneRenderer, LeapingHoldsWithTheEyeInsideTheVolumeToo) {
  RENDERER_OR_SKIP(renderer);
  renderer.setShading({false, false});
  renderer.setVolume(Grid(ball()));
  renderer.setTissues(tissues());
  renderer.lookAt(Vec3(0, 10, 0), Vec3(0.2, 1, 0), Vec3(0, 0, 1), 12.0);
  UploadProbe::setLeaping(renderer, false);
  const Picture stock = renderer.picture();
  UploadProbe::setLeaping(renderer, true);
  EXPECT_GE(psnr_dB(stock, renderer.picture()), 60.0);
}

TEST(SceneRenderer, AVoxelIsDrawnWhereTheAffineSaysAlsoInAnObliqueOrMirroredVolume) {
  RENDERER_OR_SKIP(renderer);
  const Mat3 oblique = Mat3(glm::rotate(Mat4(1.0), 0.7, glm::normalize(Vec3(1, 2, -0.5))));
  Mat3 mirrored = oblique;
  mirrored[1] = -mirrored[1];
  for (const Mat3& direction : {Mat3(1.0), oblique, mirrored}) {
    for (const Index3& marker : {Index3{8, 30, 9}, Index3{33, 6, 20}}) {
      Volume volume;
      GridGeometry& g = volume.geometry;
      g.size = {40, 36, 28};
      g.spacing_mm = Vec3(0.8, 1.1, 1.7);
      g.origin_mm = Vec3(-120, 45, 300);
      g.direction = direction;
      volume.hu.assign(g.voxelCount(), kAirHu);
      for (int k = -1; k <= 1; ++k) {
        for (int j = -1; j <= 1; ++j) {
          for (int i = -1; i <= 1; ++i) {
            volume.hu[g.indexOf(marker[0] + i, marker[1] + j, marker[2] + k)] = 1500;
          }
        }
      }
      const Vec3 focus = g.centre_mm();
      const Vec3 place = g.toPatient_mm(Vec3(marker[0], marker[1], marker[2]));
      renderer.setVolume(Grid(std::move(volume)));
      for (const Vec3& way : {Vec3(0, 1, 0), Vec3(0.5, -0.6, 0.4)}) {
        renderer.lookAt(focus, way, Vec3(0, 0, 1), 150.0);
        renderer.setTissues(tissues(0.0, 0.0));
        const Picture hidden = renderer.picture();
        renderer.setTissues(tissues());
        const Difference seen = difference(hidden, renderer.picture());
        ASSERT_GT(seen.pixels, 4);
        EXPECT_LT(glm::distance(seen.centre, pixelOf(renderer, focus, place)), 1.5);
      }
    }
  }
}

TEST(SceneRenderer, AHiddenTissueDoesNotOcclude) {
  RENDERER_OR_SKIP(renderer);
  Volume bare = ball();
  for (std::int16_t& hu : bare.hu) {
    if (hu < 300) hu = kAirHu;
  }
  renderer.setTissues(tissues());
  renderer.setVolume(Grid(ball()));
  const Picture covered = renderer.picture();
  renderer.setVolume(Grid(std::move(bare)));
  EXPECT_GE(psnr_dB(covered, renderer.picture()), 30.0);  // the shell's edge is shaded otherwise
}

TEST(SceneRenderer, ACutIsSeenWhereItIsMadeAndGoneAfterItsUndo) {
  RENDERER_OR_SKIP(renderer);
  Grid grid(ball());
  renderer.setTissues(tissues(0.4));
  renderer.setVolume(grid);
  const Picture whole = renderer.picture();
  EXPECT_FALSE(renderer.pullChanges(grid));

  const Vec3 place(10, -22, 6);  // on the side that is seen
  carve(grid, place, 9.0);
  ASSERT_TRUE(renderer.pullChanges(grid));
  const Picture cut = renderer.picture();
  const Difference seen = difference(whole, cut);
  EXPECT_GT(seen.pixels, 100);
  EXPECT_LT(glm::distance(seen.centre, pixelOf(renderer, Vec3(0.0), place)), 8.0);
  EXPECT_EQ(renderer.copy().hu, grid.snapshot().hu);

  const Volume before = ball();
  {
    auto writer = grid.takeWriter();
    for (std::size_t i = 0; i < before.hu.size(); ++i) {
      if (grid.hu(i) != before.hu[i]) writer->store(i, before.hu[i]);
    }
  }
  ASSERT_TRUE(renderer.pullChanges(grid));
  EXPECT_EQ(renderer.picture(), whole);
}

TEST(SceneRenderer, MatterThatAppearsInEmptySpaceIsDrawn) {
  RENDERER_OR_SKIP(renderer);
  Grid grid(ball());
  renderer.setTissues(tissues());
  renderer.setVolume(grid);
  const Picture whole = renderer.picture();
  const Vec3 place(0, 0, 26);
  carve(grid, place, 3.0, 1500);
  renderer.pullChanges(grid);
  const Difference seen = difference(whole, renderer.picture());
  EXPECT_GT(seen.pixels, 20);
  EXPECT_LT(glm::distance(seen.centre, pixelOf(renderer, Vec3(0.0), place)), 4.0);
}

TEST(SceneRenderer, ABoxSentAloneGivesThePictureOfAFullUpload) {
  RENDERER_OR_SKIP(renderer);
  Volume volume = ball();
  volume.hu[volume.geometry.indexOf(32, 30, 40)] = 2900;
  Grid grid(std::move(volume));
  renderer.setTissues(tissues(0.1));
  renderer.setVolume(grid);
  const Picture whole = renderer.picture();
  carve(grid, Vec3(-5, -24, 0), 12.0);
  carve(grid, Vec3(0, 0, 20), 15.0);  // the brightest voxel goes: VTK's range must not follow
  renderer.pullChanges(grid);
  const Picture by_box = renderer.picture();
  ASSERT_NE(by_box, whole);
  UploadProbe::fullUpload_ms(renderer);
  EXPECT_EQ(renderer.picture(), by_box);
  RENDERER_OR_SKIP(fresh);
  fresh.setTissues(tissues(0.1));
  fresh.setVolume(grid);
  EXPECT_EQ(fresh.picture(), by_box);
}

// Label 5 on the patient's right, x < 0, and label 7 on the left.
std::shared_ptr<const LabelMap> halves() {
  const GridGeometry g = ball().geometry;
  LabelMap map{g, std::vector<std::uint8_t>(g.voxelCount())};
  for (std::size_t i = 0; i < map.labels.size(); ++i) map.labels[i] = g.indicesOf(i)[0] < 32 ? 5 : 7;
  return std::make_shared<const LabelMap>(std::move(map));
}

// The bone of one label in this colour, of the other not at all.
TissueSet boneOf(int label, const Vec3& colour = Vec3(0.9, 0.9, 0.8)) {
  TissueSet set = tissues();
  set.tissues[1].label = label;
  set.tissues[1].colour = colour;
  return set;
}

TEST(SceneRenderer, ATissueOfALabelIsDrawnWhereItsLabelIs) {
  RENDERER_OR_SKIP(renderer);
  renderer.setVolume(Grid(ball(), halves()));
  renderer.setTissues(tissues(0.0, 0.0));
  const Picture empty = renderer.picture();
  const double middle = (kWidth - 1) / 2.0;
  renderer.setTissues(boneOf(5));
  const Picture right = renderer.picture();
  const Difference seen = difference(empty, right);
  EXPECT_GT(seen.pixels, 500);
  EXPECT_LT(seen.centre.x, middle - 10.0) << "seen from the front, the right is on the left";
  renderer.setTissues(boneOf(7));
  const Picture left = renderer.picture();
  EXPECT_GT(difference(empty, left).centre.x, middle + 10.0);
  renderer.setTissues(boneOf(6));
  EXPECT_EQ(renderer.picture(), empty);
  renderer.setTissues(boneOf(5));
  EXPECT_EQ(renderer.picture(), right);

  // Both labels, each with its own colour.
  TissueSet both = boneOf(5, Vec3(1, 0, 0));
  both.tissues.push_back(both.tissues[1]);
  both.tissues[2].id = "other";
  both.tissues[2].label = 7;
  both.tissues[2].colour = Vec3(0, 0, 1);
  renderer.setTissues(both);
  const Picture coloured = renderer.picture();
  const auto at = [&](int x, int colour) {
    return int(coloured.rgb[(std::size_t(kHeight / 2) * kWidth + std::size_t(x)) * 3 +
                            std::size_t(colour)]);
  };
  EXPECT_GT(at(kWidth / 2 - 12, 0), at(kWidth / 2 - 12, 2) + 50);
  EXPECT_GT(at(kWidth / 2 + 12, 2), at(kWidth / 2 + 12, 0) + 50);

  // Without a label map it is nowhere.
  renderer.setTissues(boneOf(5));
  renderer.setVolume(Grid(ball()));
  EXPECT_EQ(renderer.picture(), empty);
}

TEST(SceneRenderer, ALabelThatAllVoxelsHaveChangesNothingVisible) {
  RENDERER_OR_SKIP(renderer);
  const GridGeometry g = ball().geometry;
  const auto all = std::make_shared<const LabelMap>(
      LabelMap{g, std::vector<std::uint8_t>(g.voxelCount(), 5)});
  renderer.setTissues(tissues());
  renderer.setVolume(Grid(ball()));
  const Picture plain = renderer.picture();
  renderer.setVolume(Grid(ball(), all));
  EXPECT_EQ(renderer.picture(), plain) << "no tissue asks for a label";
  renderer.setTissues(boneOf(5));
  EXPECT_GE(psnr_dB(renderer.picture(), plain), 30.0) << "shaded by the label's own border";
  renderer.setShading({false, false});
  UploadProbe::setLeaping(renderer, false);
  const Picture stock = renderer.picture();
  UploadProbe::setLeaping(renderer, true);
  EXPECT_GE(psnr_dB(renderer.picture(), stock), 60.0);
}

TEST(SceneRenderer, ACutInATissueOfALabelIsSeenAlsoWhenItsRangeHoldsAir) {
  RENDERER_OR_SKIP(renderer);
  Grid grid(ball(), halves());
  TissueSet set = boneOf(5);
  set.tissues[1].hu_min = -1000;
  renderer.setTissues(set);
  renderer.setVolume(grid);
  const Picture whole = renderer.picture();
  const Vec3 place(-12, -21, 6);
  carve(grid, place, 9.0);
  ASSERT_TRUE(renderer.pullChanges(grid));
  const Picture cut = renderer.picture();
  const Difference seen = difference(whole, cut);
  EXPECT_GT(seen.pixels, 100);
  EXPECT_LT(glm::distance(seen.centre, pixelOf(renderer, Vec3(0.0), place)), 10.0);
  UploadProbe::fullUpload_ms(renderer);
  EXPECT_EQ(renderer.picture(), cut);
}

TEST(SceneRenderer, ChangesOfAnotherGridAreNotTaken) {
  RENDERER_OR_SKIP(renderer);
  renderer.setVolume(Grid(ball()));
  Volume other = ball();
  other.geometry.origin_mm.x += 1.0;
  Grid moved(std::move(other));
  carve(moved, Vec3(0.0), 5.0);
  EXPECT_FALSE(renderer.pullChanges(moved));
  EXPECT_EQ(renderer.copy().hu, ball().hu);
}

TEST(SceneRenderer, MovingFramesLeaveTheStillPictureAsItWas) {
  RENDERER_OR_SKIP(renderer);
  renderer.setTissues(tissues());
  renderer.setVolume(Grid(ball()));
  const Picture still = renderer.picture();
  renderer.setMoving(true);
  for (int frame = 0; frame < 4; ++frame) renderer.paint(0);
  EXPECT_EQ(renderer.picture(), still);
  renderer.setMoving(false);
  renderer.paint(0);
  EXPECT_EQ(renderer.picture(), still);
}
