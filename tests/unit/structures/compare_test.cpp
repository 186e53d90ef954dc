#include "structures/compare.h"

#include <gtest/gtest.h>

#include <cmath>

namespace trephine {
namespace {

LabelMap boxOf(const Index3& low, const Index3& high, std::uint8_t label) {
  LabelMap map;
  map.geometry.size = {30, 20, 20};
  map.geometry.spacing_mm = Vec3(1.0, 2.0, 3.0);
  map.labels.resize(map.geometry.voxelCount());
  for (int k = low[2]; k < high[2]; ++k) {
    for (int j = low[1]; j < high[1]; ++j) {
      for (int i = low[0]; i < high[0]; ++i) map.labels[map.geometry.indexOf(i, j, k)] = label;
    }
  }
  return map;
}

TEST(ChangedStructures, AreThoseOfOtherVoxelsNamesOrColoursAndThoseThatWent) {
  LabelMap before = boxOf({5, 5, 5}, {15, 15, 15}, 1);
  before.labels[before.geometry.indexOf(20, 10, 10)] = 2;
  before.labels[before.geometry.indexOf(21, 10, 10)] = 3;
  before.structures = {{1, "liver", Vec3(0.5)}, {2, "spleen", Vec3(0.6)}, {3, "vessel", Vec3(0.7)}};
  const auto differ = [&](const LabelMap& after) {
    const auto [changed, gone] = changedStructures(&before, &after);
    std::string words;
    for (const std::string& name : changed) words += name + ' ';
    for (const std::string& name : gone) words += '-' + name + ' ';
    return words;
  };
  LabelMap after = before;
  EXPECT_EQ(differ(after), "");
  after.labels[after.geometry.indexOf(5, 5, 5)] = 0;
  EXPECT_EQ(differ(after), "liver ");
  after = before;
  after.structures[1].name = "my spleen";
  after.structures[2].colour = Vec3(0.1);
  EXPECT_EQ(differ(after), "my spleen vessel ");
  after = before;
  after.structures.erase(after.structures.begin() + 1);
  after.labels[after.geometry.indexOf(20, 10, 10)] = 4;
  after.structures.push_back({4, "my spleen", Vec3(0.6)});
  EXPECT_EQ(differ(after), "my spleen -spleen ");
  after.structures.push_back({5, "nothing yet", Vec3(0.6)});
  EXPECT_EQ(differ(after), "my spleen -spleen ") << "it has no voxel";
  EXPECT_EQ(changedStructures(nullptr, &before).changed.size(), 3u);
  EXPECT_EQ(changedStructures(&before, nullptr).gone.size(), 3u);
}

TEST(Likeness, OfTwoBoxesIsKnown) {
  const LabelMap a = boxOf({5, 5, 5}, {15, 15, 15}, 1), b = boxOf({8, 5, 5}, {18, 15, 15}, 4);
  const auto of = likeness(a, 1, b, 4);
  ASSERT_TRUE(of);
  EXPECT_NEAR(of->dice, 0.7, 1e-9);
  EXPECT_NEAR(of->hd95_mm, 3.0, 1e-5);  // they are 3 mm apart along i
  EXPECT_NEAR(of->ml_a, 6.0, 1e-9);     // 1000 voxels of 6 mm3
  EXPECT_NEAR(of->ml_b, 6.0, 1e-9);
  const auto same = likeness(a, 1, a, 1);
  EXPECT_EQ(same->dice, 1.0);
  EXPECT_EQ(same->hd95_mm, 0.0);
}

// Where a scan ends an organ has a border too, as others count it.
TEST(Likeness, CountsTheScansFacesAsBorder) {
  const LabelMap a = boxOf({5, 5, 16}, {25, 15, 20}, 1), b = boxOf({5, 5, 15}, {25, 15, 19}, 1);
  EXPECT_NEAR(likeness(a, 1, b, 1)->hd95_mm, 3.0, 1e-5);  // one slice apart
}

TEST(Likeness, OfNothingHasNoDistance) {
  const LabelMap a = boxOf({5, 5, 5}, {15, 15, 15}, 1);
  const auto none = likeness(a, 1, a, 2);
  ASSERT_TRUE(none);
  EXPECT_EQ(none->dice, 0.0);
  EXPECT_TRUE(std::isnan(none->hd95_mm));
  EXPECT_EQ(likeness(a, 3, a, 2)->dice, 1.0);
}

TEST(Likeness, IsOfOneGridOnly) {
  const LabelMap a = boxOf({5, 5, 5}, {15, 15, 15}, 1);
  LabelMap moved = a;
  moved.geometry.origin_mm.x += 0.5;
  EXPECT_EQ(likeness(a, 1, moved, 1).error().code.str(), "OTHER_GRID");
  moved.geometry.origin_mm.x = 1e-5;  // a file's float
  EXPECT_TRUE(likeness(a, 1, moved, 1));
}

// As a file may have it: axes in the order k, i, j, and the patient's x the other way.
LabelMap turned(const LabelMap& map) {
  const GridGeometry& g = map.geometry;
  LabelMap out;
  out.geometry.size = {g.size[2], g.size[0], g.size[1]};
  out.geometry.spacing_mm = Vec3(g.spacing_mm.z, g.spacing_mm.x, g.spacing_mm.y);
  out.geometry.direction = Mat3(g.direction[2], -g.direction[0], g.direction[1]);
  out.geometry.origin_mm = g.toPatient_mm(Vec3(g.size[0] - 1, 0, 0));
  out.labels.resize(map.labels.size());
  for (std::size_t v = 0; v < map.labels.size(); ++v) {
    const Index3 at = g.indicesOf(v);
    out.labels[out.geometry.indexOf(at[2], g.size[0] - 1 - at[0], at[1])] = map.labels[v];
  }
  return out;
}

TEST(Likeness, IsOfPlacesInThePatientWhateverOrderAFileHasThem) {
  const LabelMap a = boxOf({5, 5, 5}, {15, 15, 15}, 1), b = boxOf({8, 5, 5}, {18, 15, 15}, 4);
  const auto of = likeness(a, 1, turned(b), 4);
  ASSERT_TRUE(of) << of.error().sentence();
  EXPECT_NEAR(of->dice, 0.7, 1e-9);
  EXPECT_NEAR(of->hd95_mm, 3.0, 1e-5);
  LabelMap shorter = turned(b);
  shorter.geometry.size[0] -= 1;
  shorter.labels.resize(shorter.geometry.voxelCount());
  EXPECT_EQ(likeness(a, 1, shorter, 4).error().code.str(), "OTHER_GRID");
}

}  // namespace
}  // namespace trephine
