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
  EXPECT_EQ(cutMark(1200), -1001);
  EXPECT_EQ(cutMark(-1000), -1001);
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

TEST(CutFaces, LightTissueTurnsPinkAndDarkTissueDarkerAndRedder) {
  const Vec3 bone(0.93, 0.89, 0.78), liver(0.55, 0.2, 0.16);
  const Vec3 cut_bone = cutColour(bone), cut_liver = cutColour(liver);
  EXPECT_GT(cut_bone.r, bone.r);
  EXPECT_LT(cut_bone.g, 0.85 * bone.g);
  EXPECT_LT(cut_liver.r, bone.r);
  EXPECT_LT(cut_liver.r, liver.r);
  EXPECT_GT(cut_liver.r / cut_liver.g, 1.3 * liver.r / liver.g);
  for (const Vec3& any : {Vec3(0.0), Vec3(1.0), Vec3(1, 0, 0)}) {
    const Vec3 cut = cutColour(any);
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(cut[c], 0.0);
      EXPECT_LE(cut[c], 1.0);
    }
  }
}

}  // namespace
