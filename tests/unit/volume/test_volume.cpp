#include <gtest/gtest.h>

#include <limits>

#include "volume/volume.h"
#include "volumes.h"

namespace trephine {
namespace {

using test::obliqueVolume;

TEST(Volume, IndexAndIndicesAreInverse) {
  GridGeometry g;
  g.size = {3, 5, 7};
  std::size_t expected = 0;
  for (int k = 0; k < 7; ++k) {
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 3; ++i, ++expected) {
        EXPECT_EQ(g.indexOf(i, j, k), expected);
        EXPECT_EQ(g.indicesOf(expected), (Index3{i, j, k}));
      }
    }
  }
}

TEST(Volume, TheAffinesColumnsAreTheAxesTimesTheirSpacing) {
  const GridGeometry g = obliqueVolume({4, 5, 6}).geometry;
  const Mat4 affine = g.voxelToPatient();
  EXPECT_EQ(Vec3(affine[1]), g.direction[1] * 1.1);
  EXPECT_EQ(Vec3(affine[3]), g.origin_mm);
  const Vec3 p = g.toPatient_mm({1, 2, 3});
  const Vec3 back = Vec3(g.patientToVoxel() * glm::dvec4(p, 1.0));
  EXPECT_LT(glm::distance(back, Vec3(1, 2, 3)), 1e-9);
  EXPECT_NEAR(g.voxelVolume_mm3(), 0.7 * 1.1 * 2.5, 1e-12);
}

TEST(Volume, HashIsThatOfTheBytesInMemoryOrder) {
  Volume volume;
  volume.geometry.size = {2, 1, 1};
  volume.hu = {0x0201, -1};
  // sha256 of 01 02 ff ff, from another tool.
  EXPECT_EQ(volumeSha256(volume),
            "1b6dd05c65b015573ced7de8b6bbd987291aa3b0b0a5a1fbd840a4cbcd5f61c1");
}

TEST(Volume, ACopyHasEveryVoxel) {
  for (const Index3& size : {Index3{5, 6, 7}, Index3{130, 131, 129}}) {  // more than one block
    const Volume volume = obliqueVolume(size);
    const Volume copy = copyOf(volume);
    EXPECT_TRUE(copy.geometry == volume.geometry);
    EXPECT_TRUE(copy.hu == volume.hu);
    EXPECT_NE(copy.hu.data(), volume.hu.data());
  }
}

TEST(Volume, AnImpossibleSizeIsRefusedBeforeAnythingIsAllocated) {
  EXPECT_TRUE(checkSize({512, 512, 300}, "f"));
  EXPECT_EQ(checkSize({0, 5, 5}, "f").error().code.str(), "BAD_SIZE");
  EXPECT_EQ(checkSize({5, -1, 5}, "f").error().code.str(), "BAD_SIZE");
  EXPECT_EQ(checkSize({2147483647, 2147483647, 2147483647}, "f").error().code.str(), "TOO_LARGE");
  EXPECT_EQ(checkSize({11, 10, 10}, "f", 1099).error().code.str(), "TOO_LARGE");
  EXPECT_TRUE(checkSize({11, 10, 10}, "f", 1100));
}

TEST(Volume, SamplingIsTrilinearInThePatient) {
  Volume volume = obliqueVolume({5, 6, 7});
  for (int k = 0; k < 7; ++k) {
    for (int j = 0; j < 6; ++j) {
      for (int i = 0; i < 5; ++i) {
        volume.hu[volume.geometry.indexOf(i, j, k)] = std::int16_t(10 * i + 100 * j - 50 * k);
      }
    }
  }
  const Vec3 at(1.25, 3.5, 4.75);
  EXPECT_NEAR(sampleHu(volume, volume.geometry.toPatient_mm(at)), 12.5 + 350 - 237.5, 1e-6);
}

TEST(Volume, SamplesOutsideAreAirWhateverThePosition) {
  const Volume volume = obliqueVolume({5, 6, 7});
  const GridGeometry& g = volume.geometry;
  EXPECT_EQ(sampleHu(volume, g.toPatient_mm({-1.5, 2, 2})), kAirHu);
  EXPECT_EQ(sampleHu(volume, g.toPatient_mm({2, 2, 7.5})), kAirHu);
  EXPECT_EQ(sampleHu(volume, Vec3(1e300)), kAirHu);
  EXPECT_EQ(sampleHu(volume, Vec3(std::numeric_limits<double>::quiet_NaN())), kAirHu);
  // Half a voxel outside is half air.
  EXPECT_NEAR(sampleHu(volume, g.toPatient_mm({-0.5, 2, 3})), 0.5 * (kAirHu + volume.at(0, 2, 3)),
              1e-6);
}

}  // namespace
}  // namespace trephine
