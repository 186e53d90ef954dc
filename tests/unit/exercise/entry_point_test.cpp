#include "exercise/entry_point.h"

#include <gtest/gtest.h>

#include "base/system.h"

namespace trephine {
namespace {

// A skull of 60 to 66 mm, brain within and scalp to 70 mm without, in air.
Volume headOfBalls() {
  Volume volume;
  volume.geometry.size = {160, 160, 160};
  volume.geometry.spacing_mm = Vec3(1.0);
  volume.hu.assign(volume.geometry.voxelCount(), -1000);
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    const Index3 at = volume.geometry.indicesOf(n);
    const double r = glm::length(volume.geometry.toPatient_mm(Vec3(at[0], at[1], at[2])) -
                                 volume.geometry.centre_mm());
    if (r < 70.0) volume.hu[n] = r < 60.0 ? 35 : r < 66.0 ? 1000 : 40;
  }
  return volume;
}

TissueSet bone() {
  TissueSet set;
  Tissue tissue;
  tissue.id = "bone";
  tissue.hu_min = 300;
  tissue.hu_max = 3000;
  set.tissues = {tissue};
  return set;
}

TEST(EntryPoint, TheDirectionIsOutOfTheSkinOrTheBoneThatWasClicked) {
  const Volume volume = headOfBalls();
  const Vec3 middle = volume.geometry.centre_mm();
  for (const Vec3& side : {Vec3(1, 0, 0), Vec3(0, -1, 0), glm::normalize(Vec3(1, -2, 3))}) {
    const auto skin = outwardAt(volume, bone(), nullptr, "bone", middle + 70.0 * side);
    ASSERT_TRUE(skin);
    EXPECT_GT(glm::dot(*skin, side), 0.98);
  }
  // Deeper than the ball reaches the air: the bone's own outer side.
  Volume thick = volume;
  for (std::size_t n = 0; n < thick.hu.size(); ++n) {
    if (thick.hu[n] == -1000) thick.hu[n] = 40;
  }
  const auto outer = outwardAt(thick, bone(), nullptr, "bone", middle + Vec3(0, 0, 67));
  ASSERT_TRUE(outer);
  EXPECT_GT(outer->z, 0.98);
  EXPECT_FALSE(outwardAt(thick, bone(), nullptr, "bone", middle));
  EXPECT_FALSE(outwardAt(thick, bone(), nullptr, "none", middle + Vec3(0, 0, 66)));
}

TEST(EntryPoint, HowDeepInTissueAPlaceLiesIsMeasuredOnTheWayOut) {
  const Volume volume = headOfBalls();
  const Vec3 middle = volume.geometry.centre_mm(), side(0, -1, 0);
  const auto depth = [&](const TissueSet& set, double from_mm) {
    return depthInTissue_mm(volume, set, nullptr, middle + from_mm * side, side);
  };
  EXPECT_LE(depth(bone(), 66.0), 1.0);
  EXPECT_EQ(depth(bone(), 75.0), 0.0) << "in air";
  EXPECT_NEAR(depth(bone(), 61.0), 5.0, 1.0);
  TissueSet all = bone();
  all.tissues[0].hu_min = 0;
  EXPECT_NEAR(depth(all, 0.0), 70.0, 1.0);
  EXPECT_NEAR(depth(all, 40.0), 30.0, 1.0);
}

TEST(EntryPoint, AStructuresLabelIsItsTissue) {
  Volume volume = headOfBalls();
  const GridGeometry& g = volume.geometry;
  std::fill(volume.hu.begin(), volume.hu.end(), std::int16_t(50));
  LabelMap labels{g, std::vector<std::uint8_t>(g.voxelCount())};
  for (std::size_t n = 0; n < labels.labels.size(); ++n) labels.labels[n] = g.indicesOf(n)[0] < 80;
  TissueSet set = bone();
  set.tissues[0].hu_min = 0;
  set.tissues[0].hu_max = 100;
  set.tissues[0].label = 1;
  const auto out = outwardAt(volume, set, &labels, "bone", g.toPatient_mm({79.0, 80.0, 80.0}));
  ASSERT_TRUE(out);
  EXPECT_GT(out->x, 0.98);
}

TEST(EntryPoint, ThePlaceGoesThroughTheExercisesFileAndIsFoundAgain) {
  auto exercise = readExercise(resourceFolder() / "scenes" / "cranium.json");
  ASSERT_TRUE(exercise) << exercise.error().sentence();
  const Landmark* before = entryLandmark(*exercise);
  ASSERT_TRUE(before);
  const Volume volume = headOfBalls();
  const Vec3 at = volume.geometry.centre_mm() + Vec3(66, 0, 0);
  exercise->landmarks.front() = placedAt(*before, at, Vec3(2, 0, 0));
  const auto again = parseExercise(toJson(*exercise), "scene.json");
  ASSERT_TRUE(again) << again.error().sentence();
  const auto placed = placeLandmarks(*again, volume);
  ASSERT_TRUE(placed) << placed.error().sentence();
  EXPECT_NEAR(glm::length(placed->front().frame.position_mm - at), 0.0, 1e-9);
  EXPECT_NEAR((placed->front().frame.rotation * Vec3(0, 0, 1)).x, 1.0, 1e-9);

  exercise->landmarks.front().at_mm = at + Vec3(1000, 0, 0);
  EXPECT_EQ(placeLandmarks(*exercise, volume).error().code.str(), "NO_PLACE");
}

}  // namespace
}  // namespace trephine
