#include "haptics/contact.h"

#include <limits>

#include "haptics_support.h"

namespace trephine {
namespace {

using test::boneSlab;
using test::boneTable;

struct Probe {
  explicit Probe(const Tool& tool, Volume volume = boneSlab(),
                 const TissueTable& tissues = boneTable(), std::uint32_t by_points = 0)
      : grid(std::move(volume)), tissue(grid, tissues), contact(tool, grid.geometry(), by_points) {}
  // As it is after a few ticks there.
  const Contact& touch(const Vec3& tip_mm, const Quat& orientation = Quat(1, 0, 0, 0)) {
    for (int n = 0; n < 3; ++n) look(tip_mm, orientation);
    return look(tip_mm, orientation);
  }
  const Contact& look(const Vec3& tip_mm, const Quat& orientation) {
    return contact.update(tissue, {tip_mm, orientation});
  }
  Grid grid;
  TissueField tissue;
  ToolContact contact;
};

TEST(Contact, ATipInBoneTouchesBone) {
  Probe probe(makeNeedle(0.05));
  const Contact& contact = probe.touch({0, 0, -3});
  EXPECT_EQ(contact.tissue_class, 0);
  EXPECT_EQ(contact.points, 1);
}

TEST(Contact, AToolOutsideTheVolumeCountsAsAir) {
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3& tip : {Vec3(0, 0, -100), Vec3(1e300, 0, 0), Vec3(inf, 0, 0), Vec3(nan, 0, 0)}) {
    EXPECT_FALSE(Probe(makeNeedle(0.05)).touch(tip).touching());
  }
}

TEST(Contact, ABladeCountsOnlyItsPointsInTissue) {
  Probe probe(makeBlade(0.010, 11));
  // Tip 5 mm below the surface, the blade's 11 points 1 mm apart upwards.
  // Bone ends half a voxel above z = -1; the blade's side reaches 0.6 mm and half a voxel further.
  EXPECT_EQ(probe.touch({0, 0, -5.25}).points, 6);
  EXPECT_EQ(probe.contact.classes()[5], 0);
  EXPECT_EQ(probe.contact.classes()[6], -1);
}

TEST(Contact, TheBladeTurnsWithTheTool) {
  Probe probe(makeBlade(0.010, 11));
  const Quat sideways = glm::angleAxis(glm::radians(90.0), Vec3(0, 1, 0));  // +z becomes +x
  EXPECT_EQ(probe.touch({0, 0, -5.25}, sideways).points, 11);
}

TEST(Contact, APointTouchesBeforeTheSurfaceOfItsToolAndNoFurther) {
  Probe probe(makeNeedle(0.05));  // 0.6 mm, and half a voxel: bone begins at -0.5
  EXPECT_FALSE(probe.touch({0, 0, 0.7}).touching());
  EXPECT_TRUE(probe.touch({0, 0, 0.5}).touching());
  EXPECT_TRUE(probe.touch({0, 0, -1}).touching());
  EXPECT_FALSE(probe.touch({0, 0, 0.7}).touching());
}

// The tip cuts the slot; what follows in it rubs on its walls.
TEST(Contact, ABladeTouchesTheWallsOfItsOwnSlot) {
  Volume volume = boneSlab();
  for (int k = 0; k < 32; ++k) volume.hu[volume.geometry.indexOf(16, 16, k)] = kAirHu;
  Probe probe(makeBlade(0.010, 11), std::move(volume));
  EXPECT_EQ(probe.touch({0, 0, -12}).points, 11);
}

TEST(Contact, TheFirmestTissueTouchedCounts) {
  Volume volume = boneSlab();
  for (std::size_t i = 0; i < 32 * 32 * 8; ++i) volume.hu[i] = 40;  // soft below z = -8
  TissueTable table = boneTable();
  table.count = 2;
  table.classes[1] = {{50.0, 10.0, 0.1, 0.0, 0.0}, 0, 80, 1, 0};
  Probe probe(makeBlade(0.008, 9), std::move(volume), table);
  EXPECT_EQ(probe.touch({0, 0, -12}).points, 9);
  EXPECT_EQ(probe.contact.contact().tissue_class, 0);
}

// The seed paper's rule, in the slab whose bone ends at z = -0.5.
constexpr std::uint32_t kBoneAlone = 1u << 0;

TEST(Contact, ByPointsAloneOnlyTheVoxelThatAPointLiesInCounts) {
  Probe probe(makeBlade(0.010, 11), boneSlab(), boneTable(), kBoneAlone);
  EXPECT_FALSE(probe.touch({0, 0, -0.4}).touching());
  EXPECT_EQ(probe.touch({0, 0, -0.6}).points, 1);
  EXPECT_EQ(probe.touch({0, 0, -5.25}).points, 5);
  EXPECT_FALSE(probe.contact.wouldTouch(probe.tissue, {Vec3(0, 0, -0.4), Quat(1, 0, 0, 0)}));
  EXPECT_TRUE(probe.contact.wouldTouch(probe.tissue, {Vec3(0, 0, -0.6), Quat(1, 0, 0, 0)}));
}

TEST(Contact, ByPointsAloneNoOtherTissueIsTouched) {
  Volume volume = boneSlab();
  for (std::size_t i = 0; i < 32 * 32 * 8; ++i) volume.hu[i] = 40;  // soft below z = -8.5
  TissueTable table = boneTable();
  table.count = 2;
  table.classes[1] = {{50.0, 10.0, 0.1, 0.0, 0.0}, 0, 80, 1, 0};
  Probe probe(makeBlade(0.008, 9), std::move(volume), table, kBoneAlone);
  EXPECT_EQ(probe.touch({0, 0, -12}).points, 5);
  EXPECT_EQ(probe.contact.classes()[0], -1) << "its tip is in soft tissue";
  EXPECT_EQ(probe.contact.classes()[8], 0);
}

TEST(Contact, ByPointsAloneNothingTouchesWhileTheTipIsOutsideOfTheVolume) {
  Probe probe(makeBlade(0.010, 11), boneSlab(), boneTable(), kBoneAlone);
  EXPECT_EQ(probe.touch({0, 0, -16.4}).points, 11);
  const Pose outside{Vec3(0, 0, -16.6), Quat(1, 0, 0, 0)};
  EXPECT_FALSE(probe.touch(outside.position).touching());
  EXPECT_EQ(probe.contact.classes()[5], -1);
  EXPECT_FALSE(probe.contact.wouldTouch(probe.tissue, outside));
}

TEST(TissueLookup, AnswersAsClassifyDoesForEveryHu) {
  TissueTable table = boneTable();
  table.count = 3;
  table.classes[1] = {{1, 1, 1, 0, 0}, -32768, -1000, 1, 0};
  table.classes[2] = {{1, 1, 1, 0, 0}, 3072, 32767, 1, 0};
  TissueLookup lookup;
  lookup.set(table);
  for (int hu = -32768; hu <= 32767; ++hu) {
    ASSERT_EQ(lookup.classOf(std::int16_t(hu)), classify(table, std::int16_t(hu))) << hu;
  }
}

}  // namespace
}  // namespace trephine
