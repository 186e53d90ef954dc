#include "haptics/contact.h"

#include <limits>

#include "haptics_support.h"

namespace trephine {
namespace {

using test::boneSlab;
using test::boneTable;

struct Probe {
  Grid grid{boneSlab()};
  Mat4 to_voxel = grid.geometry().patientToVoxel();
  std::vector<Hit> hits;
  Contact touch(const Tool& tool, const Vec3& tip_mm, const Contact& before = {},
                const Quat& orientation = Quat(1, 0, 0, 0)) {
    hits.reserve(tool.points_m.size());
    return findContact(grid, to_voxel, boneTable(), tool, {tip_mm, orientation}, before, 1.5, hits);
  }
};

TEST(Contact, ATipInBoneTouchesBone) {
  Probe probe;
  const Contact contact = probe.touch(makeNeedle(0.05), {0, 0, -3});
  EXPECT_EQ(contact.tissue_class, 0);
  EXPECT_EQ(contact.points, 1);
  ASSERT_EQ(probe.hits.size(), 1u);
  EXPECT_EQ(probe.grid.hu(probe.hits[0].voxel), test::kBoneHu);
}

TEST(Contact, AToolOutsideTheVolumeCountsAsAir) {
  Probe probe;
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3& tip : {Vec3(0, 0, -100), Vec3(1e300, 0, 0), Vec3(inf, 0, 0), Vec3(nan, 0, 0)}) {
    EXPECT_FALSE(probe.touch(makeNeedle(0.05), tip).touching());
    EXPECT_TRUE(probe.hits.empty());
  }
}

TEST(Contact, ABladeCountsOnlyItsPointsInTissue) {
  Probe probe;
  // Tip 5 mm below the surface, the blade's 11 points 1 mm apart upwards.
  const Contact contact = probe.touch(makeBlade(0.010, 11), {0, 0, -5.25});
  EXPECT_EQ(contact.points, 5);  // bone ends half a voxel above z = -1
}

TEST(Contact, TheBladeTurnsWithTheTool) {
  Probe probe;
  const Quat sideways = glm::angleAxis(glm::radians(90.0), Vec3(0, 1, 0));  // +z becomes +x
  EXPECT_EQ(probe.touch(makeBlade(0.010, 11), {0, 0, -5.25}, {}, sideways).points, 11);
}

TEST(Contact, IsHeldWhileTissueIsNearAndLostWhenItIsNot) {
  Probe probe;
  const Contact before{0, 1};
  EXPECT_TRUE(probe.touch(makeNeedle(0.05), {0, 0, 0.6}, before).touching());
  EXPECT_TRUE(probe.hits.empty());
  EXPECT_FALSE(probe.touch(makeNeedle(0.05), {0, 0, 0.6}).touching());
  EXPECT_FALSE(probe.touch(makeNeedle(0.05), {0, 0, 3.0}, before).touching());
}

TEST(Contact, TheFirmestTissueTouchedCounts) {
  Volume volume = boneSlab();
  for (std::size_t i = 0; i < 32 * 32 * 8; ++i) volume.hu[i] = 40;  // soft below z = -8
  Grid grid(std::move(volume));
  TissueTable table = boneTable();
  table.count = 2;
  table.classes[1] = {0, 80, 50.0, 10.0, 0.1, 1, 0};
  std::vector<Hit> hits;
  const Contact contact = findContact(grid, grid.geometry().patientToVoxel(), table,
                                      makeBlade(0.008, 9), {{0, 0, -12}, {1, 0, 0, 0}}, {}, 1.5, hits);
  EXPECT_EQ(contact.points, 9);
  EXPECT_EQ(contact.tissue_class, 0);
}

TEST(Tool, PointKOfABladeLiesKOverITimesItsLengthAlongIt) {
  const Tool blade = makeBlade(0.020, 5);
  for (int k = 0; k < 5; ++k) {
    EXPECT_DOUBLE_EQ(blade.points_m[std::size_t(k)].z, 0.020 * k / 4.0);
    EXPECT_EQ(blade.points_m[std::size_t(k)].x, 0.0);
  }
}

TEST(Tool, RefusesLengthsAndPointCountsThatCannotBe) {
  EXPECT_TRUE(makeTool(ToolKind::blade, 0.0, 1).ok());
  EXPECT_TRUE(makeTool(ToolKind::blade, 1.0, 10000).ok());
  EXPECT_EQ(makeTool(ToolKind::blade, 1.1, 5).error().where, "length_mm");
  EXPECT_EQ(makeTool(ToolKind::blade, std::nan(""), 5).error().code, "BAD_TOOL");
  EXPECT_EQ(makeTool(ToolKind::blade, 0.1, 0).error().where, "points");
}

}  // namespace
}  // namespace trephine
