#include "structures/structure_picture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace trephine {
namespace {

// Soft tissue all over a box of 80 x 60 x 100 mm; a ball of 12 mm at a place in it, in LPS.
struct Scan {
  Volume volume;
  LabelMap map;
};
Scan ballAt(const Vec3& middle_mm, const Mat3& direction) {
  Scan scan;
  GridGeometry& g = scan.volume.geometry;
  g.direction = direction;
  // So many voxels along the axis that is nearest to each of the patient's.
  const Vec3 extent(80.0, 60.0, 100.0);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 along = glm::abs(direction[axis]);
    g.size[std::size_t(axis)] = int(std::lround(glm::dot(along, extent) / 2.0));
  }
  g.spacing_mm = Vec3(2.0);
  g.origin_mm = Vec3(0.0);
  g.origin_mm = -g.centre_mm();
  scan.volume.hu.assign(g.voxelCount(), 0);
  scan.map = {g, std::vector<std::uint8_t>(g.voxelCount())};
  for (std::size_t n = 0; n < scan.map.labels.size(); ++n) {
    const Index3 at = g.indicesOf(n);
    if (glm::length(g.toPatient_mm(Vec3(at[0], at[1], at[2])) - middle_mm) < 12.0) {
      scan.map.labels[n] = 3;
    }
  }
  return scan;
}

bool isRed(const ColourPicture& picture, int x, int y) {
  const std::uint8_t* at = &picture.rgb[3 * std::size_t(y * picture.width + x)];
  return at[0] > 40 && at[1] == 0 && at[2] == 0;
}

TEST(StructurePicture, ShowsTheStructureWhereItLiesSeenFromTheFront) {
  const Mat3 standing(1.0), lying(Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(-1, 0, 0));
  for (const Mat3& direction : {standing, lying}) {
    // To the patient's left, above the middle.
    const Scan scan = ballAt({25.0, 0.0, 30.0}, direction);
    const StructurePictures pictures(scan.volume, 100);
    const ColourPicture picture = pictures.of(scan.map, 3, Vec3(1, 0, 0));
    EXPECT_EQ(picture.height, 100);
    EXPECT_EQ(picture.width, 80);
    EXPECT_TRUE(isRed(picture, 65, 20));
    EXPECT_FALSE(isRed(picture, 15, 20));
    EXPECT_FALSE(isRed(picture, 65, 80));
    int red = 0;
    for (int y = 0; y < 100; ++y) {
      for (int x = 0; x < 80; ++x) red += isRed(picture, x, y);
    }
    EXPECT_NEAR(red, M_PI * 144.0, 0.1 * M_PI * 144.0);
  }
}

TEST(StructurePicture, WhatLooksToTheLightIsBrighter) {
  const Scan scan = ballAt({0.0, 0.0, 0.0}, Mat3(1.0));
  const ColourPicture picture = StructurePictures(scan.volume, 100).of(scan.map, 3, Vec3(1, 0, 0));
  const auto red = [&](int x, int y) { return picture.rgb[3 * std::size_t(y * 80 + x)]; };
  EXPECT_GT(red(34, 43), red(46, 57) + 30);  // left above against right below
}

TEST(StructurePicture, WithoutAVoxelItIsTheScanAlone) {
  const Scan scan = ballAt({0.0, 0.0, 0.0}, Mat3(1.0));
  const ColourPicture picture = StructurePictures(scan.volume, 40).of(scan.map, 9, Vec3(1, 0, 0));
  for (std::size_t n = 0; n < picture.rgb.size(); n += 3) {
    ASSERT_EQ(picture.rgb[n], picture.rgb[n + 1]);
  }
}

}  // namespace
}  // namespace trephine
