#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/look_table.h"
#include "scenes.h"

namespace trephine {
namespace {

TEST(TissueShades, AreOfVisibleTissuesAloneThoseWithALabelLast) {
  TissueSet set = test::tissues(0.4, 0.9);
  Tissue liver = test::tissue("liver", -200, 3071, Vec3(0.5, 0.2, 0.1), 0.8);
  liver.label = 7;
  set.tissues.insert(set.tissues.begin(), liver);
  set.tissues.push_back(test::tissue("fat", -900, -101, Vec3(1.0), 0.0));
  const auto shades = tissueShades(set, {{"bone", TissueLook::ghosted}}, 3071.0);
  ASSERT_EQ(shades.size(), 3u);
  EXPECT_EQ(shades[0].low_HU, -100.5);
  EXPECT_EQ(shades[0].high_HU, 199.5);
  EXPECT_EQ(shades[0].row, 0);
  EXPECT_FALSE(shades[0].ghosted);
  EXPECT_TRUE(shades[1].ghosted);
  EXPECT_EQ(shades[2].row, 1);
  EXPECT_EQ(shades[2].colour, liver.colour);
}

TEST(TissueShades, OnlyATissueWithHuAboveItAndWithoutALabelCanBePassedBy) {
  TissueSet set = test::tissues(0.4, 0.9);
  set.tissues[1].hu_max = 3071;
  Tissue liver = test::tissue("liver", 10, 90, Vec3(0.5, 0.2, 0.1), 0.8);
  liver.label = 7;
  set.tissues.push_back(liver);
  auto shades = tissueShades(set, {}, 3071.0);
  EXPECT_TRUE(shades[0].passed);
  EXPECT_FALSE(shades[1].passed) << "nothing lies above bone";
  EXPECT_FALSE(shades[2].passed) << "its label says where it is";
  shades = tissueShades(set, {}, 9000.0);
  EXPECT_TRUE(shades[1].passed) << "metal does";
}

// What the ball says of a field, at a place.
template <class Field>
Vec3 sumOver(const RayBall& ball, const Field& field) {
  Vec3 sum(0.0);
  for (const RayPlace& place : ball) sum += place.weight * field(place.from_mm);
  return sum;
}

TEST(RayBall, OfAFlatEdgeItIsTheNormalAsLongAsTheContrast) {
  for (const Vec3& spacing : {Vec3(0.8, 0.8, 1.0), Vec3(1.0), Vec3(0.4, 0.4, 0.4)}) {
    for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0, 0, -1), Vec3(0.5, -0.7, 0.3)}) {
      const Vec3 normal = glm::normalize(way);
      const Vec3 sum = sumOver(rayBall(spacing), [&](const Vec3& at) {
        return -1000.0 + 2200.0 * std::clamp(glm::dot(at, normal) / spacing.x + 0.5, 0.0, 1.0);
      });
      EXPECT_NEAR(glm::length(sum), 2200.0, 220.0);
      EXPECT_GT(glm::dot(sum, normal) / glm::length(sum), std::cos(glm::radians(8.0)));
    }
  }
}

TEST(RayBall, OfASlopeItIsTheSlopesDirectionAlsoWhereVoxelsAreTwentyTimesAsHigh) {
  for (const Vec3& spacing : {Vec3(0.8, 0.8, 1.0), Vec3(0.5, 0.5, 10.0)}) {
    for (const RayBall& ball : {rayBall(spacing), centralDifferences(spacing)}) {
      const Vec3 slope = glm::normalize(Vec3(0.4, -0.8, 0.3));
      const Vec3 sum = sumOver(ball, [&](const Vec3& at) { return glm::dot(at, slope); });
      EXPECT_GT(glm::dot(sum, slope) / glm::length(sum), std::cos(glm::radians(3.0)));
    }
  }
}

}  // namespace
}  // namespace trephine
