#include <gtest/gtest.h>

#include <cmath>

#include "volume/reduce.h"
#include "volumes.h"

namespace trephine {
namespace {

using test::obliqueVolume;
using test::patternVolume;

TEST(Crop, EveryVoxelKeepsItsValueAndItsPlaceInThePatient) {
  const Volume whole = obliqueVolume({9, 8, 7});
  const VoxelBox box{{2, 0, 3}, {7, 8, 6}};
  const auto part = crop(whole, box);
  ASSERT_TRUE(part.ok());
  EXPECT_EQ(part->geometry.size, (Index3{5, 8, 3}));
  EXPECT_EQ(part->hu.size(), 5u * 8 * 3);
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 8; ++j) {
      for (int i = 0; i < 5; ++i) {
        ASSERT_EQ(part->at(i, j, k), whole.at(i + 2, j, k + 3));
        ASSERT_LT(glm::distance(part->geometry.toPatient_mm(Vec3(i, j, k)),
                                whole.geometry.toPatient_mm(Vec3(i + 2, j, k + 3))),
                  1e-9);
      }
    }
  }
}

TEST(Crop, InPlaceIsTheSameInTheSameMemory) {
  Volume whole = patternVolume({70, 60, 50});
  const VoxelBox box{{3, 5, 7}, {61, 41, 50}};
  const Volume expected = crop(whole, box).value();
  const std::int16_t* memory = whole.hu.data();
  const auto part = crop(std::move(whole), box);
  ASSERT_TRUE(part.ok());
  EXPECT_EQ(part->hu.data(), memory);
  EXPECT_EQ(part->hu, expected.hu);
  EXPECT_EQ(part->geometry, expected.geometry);
}

TEST(Crop, WhatIsCroppedInPlaceCanGrowAgain) {
  Volume part = crop(patternVolume({64, 64, 64}), {{0, 0, 0}, {64, 64, 4}}).value();
  const std::int16_t last = part.hu.back();
  part.hu.resize(std::size_t(64) * 64 * 64, 77);
  EXPECT_EQ(part.hu[64 * 64 * 4 - 1], last);
  EXPECT_EQ(part.hu[64 * 64 * 4], 77);
  EXPECT_EQ(part.hu.back(), 77);
}

TEST(Crop, TheWholeVolumeAndOneVoxelAreBoxesToo) {
  const Volume whole = patternVolume({4, 5, 6});
  EXPECT_EQ(crop(whole, {{0, 0, 0}, {4, 5, 6}})->hu, whole.hu);
  const auto one = crop(whole, {{3, 4, 5}, {4, 5, 6}});
  ASSERT_TRUE(one.ok());
  EXPECT_EQ(one->hu, Voxels{whole.hu.back()});
}

TEST(Crop, ABoxThatIsEmptyOrReachesOutsideIsRefusedAndTheVolumeStays) {
  Volume whole = patternVolume({4, 5, 6});
  for (const VoxelBox& box : {VoxelBox{{2, 0, 0}, {2, 5, 6}}, VoxelBox{{-1, 0, 0}, {4, 5, 6}},
                              VoxelBox{{0, 0, 0}, {4, 6, 6}}, VoxelBox{{0, 0, 6}, {4, 5, 7}}}) {
    EXPECT_EQ(crop(whole, box).error().code.str(), "BAD_CROP");
    EXPECT_EQ(crop(std::move(whole), box).error().code.str(), "BAD_CROP");
  }
  EXPECT_EQ(whole.hu.size(), 4u * 5 * 6);
}

TEST(Reduced, AVoxelIsTheMeanOfItsBlock) {
  const Volume whole = patternVolume({8, 12, 16});
  const auto small = reduced(whole, 4);
  ASSERT_TRUE(small.ok());
  ASSERT_EQ(small->geometry.size, (Index3{2, 3, 4}));
  for (std::size_t n = 0; n < small->hu.size(); ++n) {
    const Index3 at = small->geometry.indicesOf(n);
    double sum = 0.0;
    for (int s = 0; s < 64; ++s) {
      sum += whole.at(4 * at[0] + s % 4, 4 * at[1] + s / 4 % 4, 4 * at[2] + s / 16);
    }
    // In the default mode nearbyint is the reference: halves to even.
    ASSERT_EQ(small->hu[n], std::int16_t(std::nearbyint(sum / 64))) << n;
  }
}

TEST(Reduced, HalvesGoToTheEvenNumberOnBothSidesOfZero) {
  const auto meanOf = [](std::int16_t a, std::int16_t b) {
    Volume pair;
    pair.geometry.size = {2, 1, 1};
    pair.hu = {a, b};
    return reduced(pair, 2)->hu.at(0);
  };
  EXPECT_EQ(meanOf(0, 1), 0);
  EXPECT_EQ(meanOf(1, 2), 2);
  EXPECT_EQ(meanOf(-1, 0), 0);
  EXPECT_EQ(meanOf(-2, -1), -2);
  EXPECT_EQ(meanOf(-32768, -32768), -32768);
  EXPECT_EQ(meanOf(32767, 32767), 32767);
}

TEST(Reduced, BlocksThatAreCutByTheFarFacesAverageWhatIsThere) {
  Volume whole;
  whole.geometry.size = {3, 1, 5};
  whole.hu = {0, 10, 100, 2, 12, 200, 4, 14, 300, 6, 16, 400, 8, 18, 500};
  const auto small = reduced(whole, 2);
  ASSERT_TRUE(small.ok());
  EXPECT_EQ(small->geometry.size, (Index3{2, 1, 3}));
  EXPECT_EQ(small->hu, (Voxels{6, 150, 10, 350, 13, 500}));
}

TEST(Reduced, AVoxelLiesAtTheMiddleOfItsBlock) {
  const Volume whole = obliqueVolume({8, 8, 8});
  for (int factor : {2, 4}) {
    const GridGeometry small = reduced(whole, factor)->geometry;
    EXPECT_EQ(small.spacing_mm, whole.geometry.spacing_mm * double(factor));
    for (const Vec3& block : {Vec3(0, 0, 0), Vec3(1, 0, 1)}) {
      const Vec3 middle = block * double(factor) + 0.5 * (factor - 1);
      EXPECT_LT(glm::distance(small.toPatient_mm(block), whole.geometry.toPatient_mm(middle)),
                1e-9);
    }
  }
}

TEST(Reduced, OtherFactorsAreRefused) {
  for (int factor : {-2, 0, 1, 3, 8}) {
    EXPECT_EQ(reduced(patternVolume({8, 8, 8}), factor).error().code.str(), "BAD_FACTOR");
  }
  EXPECT_EQ(reduced(Volume(), 2).error().code.str(), "BAD_SIZE");
}

TEST(ReductionLoss, ALinearVolumeLosesNothingInside) {
  Volume whole;
  whole.geometry.size = {40, 40, 40};
  whole.hu.resize(whole.geometry.voxelCount());
  for (std::size_t n = 0; n < whole.hu.size(); ++n) {
    const Index3 at = whole.geometry.indicesOf(n);
    whole.hu[n] = std::int16_t(4 * at[0] + 8 * at[1] - 12 * at[2] - 200);
  }
  // Only the outer half block is held constant: 2 of 40 layers a side, by at most 1.5 voxels.
  const ReductionLoss loss = reductionLoss(whole, reduced(whole, 4).value(), 4);
  EXPECT_EQ(loss.samples, whole.hu.size());
  EXPECT_GT(loss.rms_hu, 0.0);
  EXPECT_LT(loss.rms_hu, 8.0);
  EXPECT_LE(loss.p99_hu, 36.0);
  EXPECT_EQ(loss.bone_lost_percent, 0.0);
}

TEST(ReductionLoss, AWallOfOneVoxelIsGoneAndThickBoneStays) {
  Volume whole;
  whole.geometry.size = {60, 60, 60};
  whole.hu.assign(whole.geometry.voxelCount(), 0);
  for (int k = 0; k < 60; ++k) {
    for (int j = 0; j < 60; ++j) whole.hu[whole.geometry.indexOf(11, j, k)] = 1000;
  }
  const ReductionLoss thin = reductionLoss(whole, reduced(whole, 4).value(), 4);
  EXPECT_EQ(thin.bone_lost_percent, 100.0);  // 1000 / 4
  EXPECT_EQ(thin.bone_volume_change_percent, -100.0);
  EXPECT_GT(thin.p99_hu, 700.0);

  for (int k = 0; k < 60; ++k) {
    for (int j = 0; j < 60; ++j) {
      for (int i = 12; i < 44; ++i) whole.hu[whole.geometry.indexOf(i, j, k)] = 1000;
    }
  }
  const ReductionLoss thick = reductionLoss(whole, reduced(whole, 2).value(), 2);
  EXPECT_LT(thick.bone_lost_percent, 5.0);
  EXPECT_LT(std::abs(thick.bone_volume_change_percent), 8.0);
}

TEST(ReductionLoss, TheSampledAnswerIsNearTheWholeOne) {
  Volume head;                           // a shell 2.3 mm thick around water
  head.geometry.size = {160, 160, 160};  // about the smallest that is not asked whole
  head.hu.resize(head.geometry.voxelCount());
  for (std::size_t n = 0; n < head.hu.size(); ++n) {
    const Index3 at = head.geometry.indicesOf(n);
    const double r = glm::distance(Vec3(at[0], at[1], at[2]), Vec3(80.3, 79.4, 78.1));
    head.hu[n] = r > 60.0 ? kAirHu : r > 57.7 ? 1000 : 0;
  }
  const Volume small = reduced(head, 2).value();
  const ReductionLoss sampled = reductionLoss(head, small, 2);
  EXPECT_EQ(sampled.stride, (Index3{3, 1, 1}));
  EXPECT_LE(sampled.samples, 4'000'000u);
  double square = 0.0;
  std::uint64_t bone = 0, lost = 0;
  for (std::size_t n = 0; n < head.hu.size(); ++n) {
    const Index3 at = head.geometry.indicesOf(n);
    const double before = head.hu[n];
    const double after = sampleHu(small, head.geometry.toPatient_mm(Vec3(at[0], at[1], at[2])));
    square += (after - before) * (after - before) / double(head.hu.size());
    bone += before > kBoneHu;
    lost += before > kBoneHu && after <= kBoneHu;
  }
  EXPECT_NEAR(sampled.rms_hu, std::sqrt(square), 0.02 * std::sqrt(square));
  EXPECT_NEAR(sampled.bone_lost_percent, 100.0 * double(lost) / double(bone), 0.5);
  EXPECT_GT(lost, 0u);
}

}  // namespace
}  // namespace trephine
