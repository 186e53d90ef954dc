#include <gtest/gtest.h>

#include "render/display_volume.h"
#include "scenes.h"

using namespace trephine;
using namespace trephine::test;

TEST(DisplayVolume, EachAxisIsHalvedAsOftenAsItNeeds) {
  EXPECT_EQ(reductionFor({512, 512, 300}, 2048, true), (Index3{1, 1, 1}));
  EXPECT_EQ(reductionFor({128, 128, 3000}, 2048, false), (Index3{1, 1, 2}));
  EXPECT_EQ(reductionFor({4097, 100, 8200}, 2048, false), (Index3{4, 1, 8}));
  // The labels' texture has an eighth more slices.
  EXPECT_EQ(reductionFor({128, 128, 2000}, 2048, false), (Index3{1, 1, 1}));
  EXPECT_EQ(reductionFor({128, 128, 2000}, 2048, true), (Index3{1, 1, 2}));
}

TEST(DisplayVolume, VoxelsAreMeansAtTheMiddleOfTheirBlocksAndFollowChanges) {
  Volume full = ball();
  DisplayVolume display(full, {2, 1, 4});
  const Volume& small = display.volume();
  EXPECT_EQ(small.geometry.size, (Index3{32, 60, 12}));
  const Vec3 middle = 0.5 * (full.geometry.toPatient_mm(Vec3(6, 9, 8)) +
                             full.geometry.toPatient_mm(Vec3(7, 9, 11)));
  EXPECT_NEAR(glm::distance(small.geometry.toPatient_mm(Vec3(3, 9, 2)), middle), 0.0, 1e-9);

  const VoxelBox changed{{5, 20, 10}, {9, 22, 13}};
  for (int k = 10; k < 13; ++k) {
    for (int j = 20; j < 22; ++j) {
      for (int i = 5; i < 9; ++i) full.hu[full.geometry.indexOf(i, j, k)] = 2000;
    }
  }
  EXPECT_EQ(display.update(full, changed), (VoxelBox{{2, 20, 2}, {5, 22, 4}}));
  EXPECT_EQ(small.hu, DisplayVolume(full, {2, 1, 4}).volume().hu);
}

TEST(DisplayVolume, ASizeThatIsNoMultipleLosesNoVoxel) {
  Volume full = ball();
  const DisplayVolume display(full, {4, 8, 32});
  DisplayVolume copy = display;
  EXPECT_EQ(copy.volume().geometry.size, (Index3{16, 8, 2}));
  EXPECT_EQ(copy.update(full, {{63, 59, 47}, {64, 60, 48}}), (VoxelBox{{15, 7, 1}, {16, 8, 2}}));
}

TEST(SceneRenderer, AVolumeThatTheGraphicsCardCannotTakeIsShownHalvedAndFollowsCuts) {
  RENDERER_OR_SKIP(renderer);
  renderer.setTissues(tissues(0.4));
  Grid grid(ball());
  renderer.setVolume(grid);
  const Picture full = renderer.picture();
  EXPECT_EQ(renderer.reduction(), (Index3{1, 1, 1}));
  EXPECT_TRUE(renderer.refusal().ok());

  RENDERER_OR_SKIP(small);
  UploadProbe::limitEdges(small, 50);
  small.setTissues(tissues(0.4));
  small.setVolume(grid);
  const Picture halved = small.picture();
  EXPECT_EQ(small.reduction(), (Index3{2, 2, 1}));
  EXPECT_TRUE(small.refusal().ok());
  EXPECT_GE(psnr_dB(full, halved), 20.0) << "the same thing at the same place, coarser";
  const Vec3 place(10, -22, 6);
  carve(grid, place, 9.0);
  ASSERT_TRUE(small.pullChanges(grid));
  const Difference seen = difference(halved, small.picture());
  EXPECT_GT(seen.pixels, 100);
  EXPECT_LT(glm::distance(seen.centre, pixelOf(small, Vec3(0.0), place)), 8.0);
  EXPECT_EQ(small.copy().hu, grid.snapshot().hu) << "the case itself is whole";
}

TEST(SceneRenderer, ALongSeriesDoesNotOpenEmpty) {
  RENDERER_OR_SKIP(renderer);
  Volume volume;
  volume.geometry.size = {32, 32, 3000};
  volume.geometry.spacing_mm = Vec3(1.0, 1.0, 0.1);
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  for (std::size_t i = 0; i < volume.hu.size(); ++i) {
    const Index3 v = volume.geometry.indicesOf(i);
    if (v[0] > 8 && v[0] < 24 && v[1] > 8 && v[1] < 24) volume.hu[i] = 1500;
  }
  renderer.setTissues(tissues(0.0, 0.0));
  renderer.setVolume(Grid(std::move(volume)));
  const Picture empty = renderer.picture();
  renderer.setTissues(tissues());
  EXPECT_GT(difference(empty, renderer.picture()).pixels, 500);
  EXPECT_TRUE(renderer.refusal().ok());
}

TEST(SceneRenderer, WhatTheGraphicsCardRefusesIsSaidAndTheNextVolumeIsShown) {
  RENDERER_OR_SKIP(renderer);
  renderer.setTissues(tissues());
  UploadProbe::limitEdges(renderer, -1);
  renderer.setVolume(Grid(ball()));
  const Picture none = renderer.picture();
  EXPECT_EQ(none.width, kWidth);
  ASSERT_FALSE(renderer.refusal().ok());
  EXPECT_EQ(renderer.refusal().error().code.str(), "VOLUME_REFUSED");
  EXPECT_TRUE(renderer.complete());
  UploadProbe::limitEdges(renderer, 0);
  renderer.setVolume(Grid(ball()));
  EXPECT_GT(difference(none, renderer.picture()).pixels, 1000);
  EXPECT_TRUE(renderer.refusal().ok());
}

TEST(SceneRenderer, OddVolumesAndViewsGiveAPictureOrNoneButNoHarm) {
  RENDERER_OR_SKIP(renderer);
  renderer.setTissues(tissues());
  const auto show = [&](const Index3& size, const Vec3& spacing, std::int16_t hu) {
    Volume volume;
    volume.geometry.size = size;
    volume.geometry.spacing_mm = spacing;
    volume.hu.assign(volume.geometry.voxelCount(), hu);
    renderer.setTissues(tissues(0.0, 0.0));
    renderer.setVolume(Grid(std::move(volume)));
    const Picture empty = renderer.picture();
    renderer.setTissues(tissues());
    return difference(empty, renderer.picture()).pixels;
  };
  EXPECT_GT(show({40, 40, 30}, Vec3(1, 1, 20), 1200), 500) << "1:20";
  EXPECT_GT(show({40, 40, 30}, Vec3(1.0), 1200), 500) << "all alike";
  EXPECT_EQ(show({40, 40, 30}, Vec3(1.0), kAirHu), 0);
  EXPECT_GE(show({64, 64, 1}, Vec3(1.0), 1200), 0) << "one slice";
  EXPECT_TRUE(renderer.refusal().ok());
  renderer.setVolume(Grid(ball()));
  renderer.resize(0, 0);
  EXPECT_EQ(renderer.picture().width, 1);
  renderer.resize(kWidth, kHeight);
  renderer.setParallel(true);
  renderer.lookAt(Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 0, 1), 1.0);  // the eye amid the volume
  EXPECT_FALSE(renderer.picture().rgb.empty());
}

TEST(SceneRenderer, OrthographicWhatIsNearIsNoLargerThanWhatIsFar) {
  RENDERER_OR_SKIP(renderer);
  Volume volume = ball();
  std::fill(volume.hu.begin(), volume.hu.end(), kAirHu);
  const GridGeometry& g = volume.geometry;
  for (const int j : {4, 54}) {  // one in front, one behind
    for (int k = 20; k < 27; ++k) {
      for (int i = j == 4 ? 10 : 46; i < (j == 4 ? 18 : 54); ++i) {
        for (int d = -2; d < 3; ++d) volume.hu[g.indexOf(i, j + d, k)] = 1500;
      }
    }
  }
  const auto sizes = [&](bool parallel) {
    renderer.setTissues(tissues(0.0, 0.0));
    renderer.setVolume(Grid(volume));
    renderer.lookAt(Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 0, 1), 120.0);
    renderer.setParallel(parallel);
    const Picture empty = renderer.picture();
    renderer.setTissues(tissues());
    const Picture with = renderer.picture();
    std::pair<int, int> pixels;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const std::size_t at = (std::size_t(y) * kWidth + std::size_t(x)) * 3;
        if (std::abs(with.rgb[at] - empty.rgb[at]) > 30)
          ++(x < kWidth / 2 ? pixels.first : pixels.second);
      }
    }
    return pixels;
  };
  const auto [near_p, far_p] = sizes(false);
  EXPECT_GT(near_p, 1.4 * far_p);
  const auto [near_o, far_o] = sizes(true);
  EXPECT_NEAR(near_o, far_o, 0.06 * far_o);
}

TEST(SceneRenderer, TissueThatIsSeenThroughTintsAToolBehindItAndBoneHidesIt) {
  RENDERER_OR_SKIP(renderer);
  renderer.setVolume(Grid(ball()));
  ToolView tool;
  tool.length_mm = 40.0;  // its handle has the colour
  tool.radius_mm = 4.0;
  tool.colour = Vec3(0, 0, 1);
  const std::size_t middle = (std::size_t(kHeight / 2) * kWidth + kWidth / 2) * 3;
  const auto blueness = [&](double soft, double bone, double y) {
    renderer.setTissues(tissues(soft, bone));
    tool.pose_mm.position = Vec3(0, y, -80);
    renderer.setTools({tool});
    const Picture picture = renderer.picture();
    return int(picture.rgb[middle + 2]) - int(picture.rgb[middle]);
  };
  const int bare = blueness(0.0, 0.0, 0.0);
  EXPECT_GT(bare, 80);
  const int tinted = blueness(0.02, 0.02, 0.0);
  EXPECT_LT(tinted, bare - 10);
  EXPECT_GT(tinted, 20);
  EXPECT_LT(blueness(0.0, 0.9, 0.0), 10) << "inside the shell of bone";
  EXPECT_GT(blueness(0.0, 0.9, -60.0), bare - 30) << "in front of it";
  EXPECT_LT(blueness(0.0, 0.9, 60.0), 10) << "behind it";
}
