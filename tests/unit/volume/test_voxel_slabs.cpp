#include <gtest/gtest.h>

#include <algorithm>

#include "volume/voxel_slabs.h"

namespace trephine {
namespace {

// 20 MB: a slab and a part of one.
Volume counted() {
  Volume volume;
  volume.geometry.size = {512, 512, 40};
  volume.geometry.spacing_mm = Vec3(0.5, 0.5, 2.0);
  volume.hu.resize(volume.geometry.voxelCount());
  for (std::size_t i = 0; i < volume.hu.size(); ++i) {
    volume.hu[i] = std::int16_t(i * 7 + i / 65536);
  }
  return volume;
}

TEST(VoxelSlabs, AreAllVoxelsInOrderAtMost16MBAtATime) {
  const Volume volume = counted();
  std::vector<std::int16_t> all;
  std::size_t largest = 0;
  EXPECT_TRUE(slabsOf(volume).forEach([&](std::span<const std::int16_t> slab) {
    all.insert(all.end(), slab.begin(), slab.end());
    largest = std::max(largest, slab.size_bytes());
    return true;
  }));
  EXPECT_TRUE(std::equal(all.begin(), all.end(), volume.hu.begin(), volume.hu.end()));
  EXPECT_EQ(largest, std::size_t(16) << 20);
}

TEST(VoxelSlabs, EndWhereTheyAreTold) {
  int taken = 0;
  const Volume volume = counted();
  EXPECT_FALSE(slabsOf(volume).forEach([&](std::span<const std::int16_t>) { return ++taken < 1; }));
  EXPECT_EQ(taken, 1);
}

TEST(VoxelSlabs, OfAGridHaveItsHash) {
  const Volume volume = counted();
  EXPECT_EQ(slabsSha256(slabsOf(volume)), volumeSha256(volume));
  Grid grid{Volume(volume)};
  EXPECT_EQ(slabsSha256(slabsOf(grid)), volumeSha256(volume));
  grid.takeWriter()->store(12345, 1);
  EXPECT_EQ(slabsSha256(slabsOf(grid)), volumeSha256(grid.snapshot()));
  EXPECT_NE(slabsSha256(slabsOf(grid)), volumeSha256(volume));
}

TEST(VoxelSlabs, WithReversedSlicesLeaveEachVoxelWhereItWasInThePatient) {
  const Volume volume = counted();
  const VoxelSlabs reversed = reversedSlices(slabsOf(volume));
  Volume out{reversed.geometry, Voxels(volume.hu.size())};
  // In pieces that end within slices.
  constexpr std::size_t kPiece = 1000003;
  for (std::size_t first = 0; first < out.hu.size(); first += kPiece) {
    const std::size_t count = std::min(kPiece, out.hu.size() - first);
    reversed.read(first, {out.hu.data() + first, count});
  }
  for (const Index3& v : {Index3{0, 0, 0}, Index3{511, 3, 39}, Index3{100, 200, 17}}) {
    const Vec3 at_mm = volume.geometry.toPatient_mm(Vec3(v[0], v[1], v[2]));
    EXPECT_EQ(sampleHu(out, at_mm), volume.at(v[0], v[1], v[2]));
  }
  EXPECT_EQ(out.geometry.direction[2], -volume.geometry.direction[2]);
}

}  // namespace
}  // namespace trephine
