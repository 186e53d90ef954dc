#include <gtest/gtest.h>

#include "volume/thick_slices.h"
#include "volumes.h"

namespace trephine {
namespace {

GridGeometry spaced(const Vec3& spacing_mm) {
  GridGeometry geometry;
  geometry.size = {8, 8, 8};
  geometry.spacing_mm = spacing_mm;
  return geometry;
}

TEST(ThickSlices, AreThoseFarApartForTouchAndForTheirPixels) {
  EXPECT_EQ(stepsBetweenSlices(spaced({0.5, 0.5, 2.5})), 1);
  EXPECT_EQ(stepsBetweenSlices(spaced({0.5, 0.5, 2.6})), 3);
  EXPECT_EQ(stepsBetweenSlices(spaced({0.5, 0.5, 5.0})), 5);
  EXPECT_EQ(stepsBetweenSlices(spaced({0.8, 0.8, 6.0})), 6);
  EXPECT_EQ(stepsBetweenSlices(spaced({2.0, 2.0, 2.9})), 1) << "reduced in all directions";
  EXPECT_EQ(stepsBetweenSlices(spaced({2.0, 2.0, 6.0})), 3) << "no finer than the pixels";
  GridGeometry one = spaced({0.5, 0.5, 5.0});
  one.size[2] = 1;
  EXPECT_EQ(stepsBetweenSlices(one), 1);
}

TEST(ThickSlices, TheScannedOnesStayAndThoseBetweenAreOnTheLineBetweenThem) {
  const Volume thick = test::obliqueVolume({9, 8, 5});
  const auto thin = withThinSlices(thick, 4);
  ASSERT_TRUE(thin.ok());
  EXPECT_EQ(thin->geometry.size, (Index3{9, 8, 17}));
  for (int k = 0; k < 17; ++k) {
    const double share = k % 4 / 4.0;
    for (int j = 0; j < 8; ++j) {
      for (int i = 0; i < 9; ++i) {
        const double low = thick.at(i, j, k / 4), high = thick.at(i, j, std::min(4, k / 4 + 1));
        ASSERT_NEAR(thin->at(i, j, k), low + share * (high - low), 0.5);
      }
    }
    ASSERT_LT(glm::distance(thin->geometry.toPatient_mm(Vec3(3, 2, k)),
                            thick.geometry.toPatient_mm(Vec3(3, 2, k / 4.0))),
              1e-9);
  }
}

TEST(ThickSlices, TheExtremesOfHuStayWithinThem) {
  Volume thick;
  thick.geometry.size = {1, 1, 3};
  thick.hu = {-32768, 32767, -32768};
  const auto thin = withThinSlices(thick, 2);
  ASSERT_TRUE(thin.ok());
  EXPECT_EQ(thin->at(0, 0, 0), -32768);
  EXPECT_EQ(thin->at(0, 0, 1), -1) << "-0.5, halves away from zero";
  EXPECT_EQ(thin->at(0, 0, 2), 32767);
  EXPECT_EQ(thin->at(0, 0, 4), -32768);
}

}  // namespace
}  // namespace trephine
