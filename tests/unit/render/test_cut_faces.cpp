// What was cut is told from what was air before: the marks, and the walls' colour in pixels.
#include <algorithm>

#include "render/cut_marks.h"
#include "render/look_table.h"
#include "scenes.h"

using namespace trephine;
using namespace trephine::test;

namespace {

// Seen from the front; air around the ball is exactly what a cut leaves.
const Vec3 kFront(0.0, 1.0, 0.0), kUp(0.0, 0.0, 1.0), kPlace(-3.0, -24.0, 2.0);
constexpr double kRadius_mm = 4.5, kEye_mm = 200.0;

struct CutBall {
  explicit CutBall(const Volume& of = ball())
      : whole(std::make_shared<const Volume>(of)), grid(of) {}
  std::shared_ptr<const Volume> whole;
  Grid grid;

  void show(SceneRenderer& renderer) {
    renderer.setTissues(tissues());
    renderer.setVolume(grid, whole);
    renderer.lookAt(Vec3(0.0), kFront, kUp, kEye_mm);
  }
  void cutAndTell(SceneRenderer& renderer) {
    carve(grid, kPlace, kRadius_mm);
    ASSERT_TRUE(renderer.pullChanges(grid));
  }
  // The same voxels, of which nobody knows that they were cut.
  Picture untold(SceneRenderer& renderer) const {
    renderer.setVolume(grid);
    return renderer.picture();
  }
};

double redness(const Picture& picture, const glm::dvec2& at) {
  const std::size_t n = 3 * (std::size_t(at.y) * std::size_t(picture.width) + std::size_t(at.x));
  return double(picture.rgb[n]) / std::max<int>(1, picture.rgb[n + 1]);
}

TEST(CutMarks, TheMarkLiesBelowAllThatAVolumeHoldsAndNearAir) {
  EXPECT_EQ(cutMark(1200), -1016);
  EXPECT_EQ(cutMark(-1000), -1016);
  EXPECT_EQ(cutMark(-1024), -1025);
  EXPECT_EQ(cutMark(-3024), -1100);
  EXPECT_EQ(cutMark(INT16_MIN), -1100);
}

TEST(CutMarks, VoxelsThatWereCutAreMarkedForAMomentAndAirThatWasThereIsNot) {
  Volume volume = ball();
  volume.hu.assign(volume.hu.size(), 700);
  volume.hu[volume.geometry.indexOf(5, 5, 5)] = kAirHu;
  const auto whole = std::make_shared<const Volume>(volume);
  VolumeMirror mirror;
  mirror.show(volume, nullptr, whole);
  Grid grid(volume);
  grid.takeWriter()->store(6, 5, 5, kAirHu);
  grid.takeWriter()->store(7, 5, 5, 300);
  mirror.pull(grid);
  const Volume before = mirror.volume();
  {
    const CutMarks marks(mirror.mutableVolume(), {{0, 0, 0}, volume.geometry.size}, mirror,
                         {1, 1, 1}, -1001);
    EXPECT_EQ(mirror.volume().at(5, 5, 5), kAirHu);
    EXPECT_EQ(mirror.volume().at(6, 5, 5), -1001);
    EXPECT_EQ(mirror.volume().at(7, 5, 5), 300);
  }
  EXPECT_EQ(mirror.volume().hu, before.hu);
  const CutMarks elsewhere(mirror.mutableVolume(), {{0, 0, 6}, volume.geometry.size}, mirror,
                           {1, 1, 1}, -1001);
  EXPECT_EQ(mirror.volume().hu, before.hu) << "beyond the box";
}

TEST(CutFaces, ACutWallHasAnotherColourAndAllElseKeepsIts) {
  RENDERER_OR_SKIP(renderer);
  CutBall exercise;
  exercise.show(renderer);
  const Picture whole = renderer.picture();
  exercise.cutAndTell(renderer);
  const Picture told = renderer.picture();
  const glm::dvec2 at = pixelOf(renderer, Vec3(0.0), kPlace);
  const double reach = (kRadius_mm + 3.5) / renderer.mmPerPixelAt(kPlace);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (glm::distance(glm::dvec2(x, y), at) < reach) continue;
      const std::size_t n = 3 * std::size_t(y * kWidth + x);
      ASSERT_TRUE(std::equal(&told.rgb[n], &told.rgb[n] + 3, &whole.rgb[n])) << x << ' ' << y;
    }
  }
  const Picture untold = exercise.untold(renderer);
  const Difference seen = difference(told, untold);
  EXPECT_GT(seen.pixels, 100);
  EXPECT_LT(glm::distance(seen.centre, at), 8.0);
  EXPECT_GT(redness(told, at), 1.15 * redness(untold, at));
}

// An organ of thick voxels, of any HU where its structure is, as the shipped liver: a cut as thin
// as a voxel is as wide as one in the picture.
TEST(CutFaces, ASlitOfOneVoxelInATissueThatIsKnownByItsLabelAloneIsSeen) {
  RENDERER_OR_SKIP(renderer);
  constexpr int kSize = 24, kFrom = 4, kTo = 20;
  constexpr double kVoxel_mm = 3.0;
  Volume organ;
  organ.geometry.size = {kSize, kSize, kSize};
  organ.geometry.spacing_mm = Vec3(kVoxel_mm);
  organ.geometry.origin_mm = Vec3(-0.5 * (kSize - 1) * kVoxel_mm);
  organ.hu.assign(organ.geometry.voxelCount(), kAirHu);
  auto labels = std::make_shared<LabelMap>();
  labels->geometry = organ.geometry;
  labels->labels.assign(organ.hu.size(), 0);
  labels->structures = {{1, "organ", Vec3(0.5)}};
  for (int k = kFrom; k < kTo; ++k) {
    for (int j = kFrom; j < kTo; ++j) {
      for (int i = kFrom; i < kTo; ++i) {
        const std::size_t voxel = organ.geometry.indexOf(i, j, k);
        organ.hu[voxel] = 100;
        labels->labels[voxel] = 1;
      }
    }
  }
  TissueSet set{"organ", {tissue("organ", -999, 3071, Vec3(0.55, 0.2, 0.16), 0.8)}};
  set.tissues[0].label = 1;
  renderer.setTissues(set);
  const auto whole = std::make_shared<const Volume>(organ);
  auto mirror = std::make_shared<VolumeMirror>();
  mirror->show(copyOf(*whole), labels, whole);
  renderer.setMirror(mirror);
  renderer.lookAt(Vec3(0.0), kFront, kUp, kEye_mm);
  const Picture before = renderer.picture();
  Grid grid(organ);
  for (int k = 7; k < 17; ++k) {
    for (int j = kFrom; j < kFrom + 6; ++j) grid.takeWriter()->store(12, j, k, kAirHu);
  }
  ASSERT_TRUE(renderer.pullChanges(grid));
  const Vec3 on_it = organ.geometry.toPatient_mm(Vec3(12, kFrom, 12));
  const double mm = renderer.mmPerPixelAt(on_it);
  const double slit_pixels = 10.0 * kVoxel_mm / mm * kVoxel_mm / mm;
  const Difference seen = difference(before, renderer.picture(), 24);
  EXPECT_GT(seen.pixels, 0.6 * slit_pixels);
  EXPECT_LT(seen.pixels, 2.5 * slit_pixels) << "with its edges, and no more than that";
  EXPECT_NEAR(seen.centre.x, pixelOf(renderer, Vec3(0.0), on_it).x, 5.0);
  // And its ground is paler than the organ.
  const glm::dvec2 at = pixelOf(renderer, Vec3(0.0), on_it);
  const auto green = [&](const Picture& in) {
    return int(in.rgb[(std::size_t(at.y) * kWidth + std::size_t(at.x)) * 3 + 1]);
  };
  EXPECT_GT(green(renderer.picture()), green(before) + 25);
}

TEST(CutFaces, TissuePutBackGivesTheOldPictureToTheBit) {
  RENDERER_OR_SKIP(renderer);
  CutBall exercise;
  exercise.show(renderer);
  const Picture before = renderer.picture();
  exercise.cutAndTell(renderer);
  EXPECT_NE(renderer.picture(), before);
  for (std::size_t n = 0; n < exercise.whole->hu.size(); ++n) {
    if (exercise.grid.hu(n) != exercise.whole->hu[n]) {
      exercise.grid.takeWriter()->store(n, exercise.whole->hu[n]);
    }
  }
  renderer.pullChanges(exercise.grid);
  EXPECT_EQ(renderer.picture(), before);
}

TEST(CutFaces, TheyAreShownTooWhereTheGridWasCutBeforeAndAfterAFullUpload) {
  RENDERER_OR_SKIP(renderer);
  CutBall exercise;
  exercise.show(renderer);
  exercise.cutAndTell(renderer);
  const Picture told = renderer.picture();
  UploadProbe::fullUpload_ms(renderer);
  EXPECT_EQ(renderer.picture(), told);

  CutBall later;
  carve(later.grid, kPlace, kRadius_mm);
  later.show(renderer);
  EXPECT_EQ(renderer.picture(), told);
}

TEST(CutFaces, AVolumeShownWithFewerVoxelsHasThemToo) {
  RENDERER_OR_SKIP(renderer);
  UploadProbe::limitEdges(renderer, 32);
  CutBall exercise;
  exercise.show(renderer);
  renderer.picture();
  ASSERT_NE(renderer.reduction(), (Index3{1, 1, 1}));
  exercise.cutAndTell(renderer);
  const Picture told = renderer.picture();
  EXPECT_GT(difference(told, exercise.untold(renderer)).pixels, 60);
}

TEST(CutFaces, WhereASeenTissueHoldsAllLowHuWhatWasCutIsGoneAllTheSame) {
  RENDERER_OR_SKIP(renderer);
  Volume noisy = ball();
  noisy.hu[0] = -1040;
  CutBall exercise(noisy);
  exercise.show(renderer);
  TissueSet set = tissues();
  set.tissues[0].hu_min = -1100;
  set.tissues[0].opacity = 0.01;
  renderer.setTissues(set);
  exercise.cutAndTell(renderer);
  const Picture told = renderer.picture();
  EXPECT_EQ(told, exercise.untold(renderer));
  // And back, where the mark is free again.
  CutBall cut_before(noisy);
  carve(cut_before.grid, kPlace, kRadius_mm);
  cut_before.show(renderer);
  renderer.setTissues(set);
  renderer.picture();
  renderer.setTissues(tissues());
  const Picture again = renderer.picture();
  CutBall other(noisy);
  carve(other.grid, kPlace, kRadius_mm);
  other.show(renderer);
  EXPECT_EQ(again, renderer.picture());
}

TEST(CutFaces, LightTissueTurnsPinkAndDarkTissuePaler) {
  const Vec3 bone(0.93, 0.89, 0.78), liver(0.55, 0.2, 0.16);
  const Vec3 cut_bone = cutColour(bone), cut_liver = cutColour(liver);
  EXPECT_GT(cut_bone.r, bone.r);
  EXPECT_LT(cut_bone.g, 0.85 * bone.g);
  EXPECT_GT(cut_liver.r, liver.r + 0.1);
  EXPECT_GT(cut_liver.g, liver.g + 0.1);
  EXPECT_GT(cut_liver.r, 1.5 * cut_liver.g) << "red still";
  for (const Vec3& any : {Vec3(0.0), Vec3(1.0), Vec3(1, 0, 0)}) {
    const Vec3 cut = cutColour(any);
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(cut[c], 0.0);
      EXPECT_LE(cut[c], 1.0);
    }
  }
}

}  // namespace
