#include <gtest/gtest.h>

#include <numeric>

#include "volume/hu_histogram.h"

namespace trephine {
namespace {

Volume ramp(int count) {
  Volume volume;
  volume.geometry.size = {count, 1, 1};
  volume.geometry.spacing_mm = Vec3(0.5, 1.0, 2.0);
  volume.hu.resize(std::size_t(count));
  for (int i = 0; i < count; ++i) volume.hu[std::size_t(i)] = std::int16_t(-1000 + i % 7);
  return volume;
}

TEST(HuHistogram, CountsEachVoxelOnceBetweenTheLowestAndTheHighest) {
  const Result<HuHistogram> all = histogramOf(ramp(1000));
  ASSERT_TRUE(all.ok());
  EXPECT_EQ(all->low_hu, -1000);
  EXPECT_EQ(all->high_hu, -994);
  EXPECT_EQ(all->voxels, 1000u);
  EXPECT_DOUBLE_EQ(all->voxel_mm3, 1.0);
  ASSERT_EQ(all->rows.size(), 1u);
  EXPECT_EQ(all->rows[0].counts, (std::vector<std::uint32_t>{143, 143, 143, 143, 143, 143, 142}));
}

TEST(HuHistogram, KeepsLabelsApartAndTheirSumIsTheWhole) {
  const Volume volume = ramp(1000);
  LabelMap labels{volume.geometry, std::vector<std::uint8_t>(1000, 0)};
  for (std::size_t v = 0; v < 300; ++v) labels.labels[v] = v < 100 ? 9 : 200;
  const Result<HuHistogram> all = histogramOf(volume, &labels);
  ASSERT_TRUE(all.ok());
  ASSERT_EQ(all->rows.size(), 3u);
  const auto sum = [](const auto& counts) {
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t(0));
  };
  EXPECT_EQ(all->rows[0].label, 0);
  EXPECT_EQ(sum(all->rows[0].counts), 700u);
  EXPECT_EQ(all->rows[1].label, 9);
  EXPECT_EQ(sum(all->rows[1].counts), 100u);
  EXPECT_EQ(all->rows[2].label, 200);
  EXPECT_EQ(sum(all->rows[2].counts), 200u);
  const Result<HuHistogram> without = histogramOf(volume);
  EXPECT_EQ(all->whole(), without->whole());
}

TEST(HuHistogram, HoldsTheExtremesOfHu) {
  Volume volume = ramp(2);
  volume.hu[0] = 32767;
  volume.hu[1] = -32768;
  const Result<HuHistogram> all = histogramOf(volume);
  ASSERT_TRUE(all.ok());
  EXPECT_EQ(all->low_hu, -32768);
  EXPECT_EQ(all->high_hu, 32767);
  EXPECT_EQ(all->rows[0].counts.front(), 1u);
  EXPECT_EQ(all->rows[0].counts.back(), 1u);
}

TEST(HuHistogram, OfNothingIsEmptyAndACancelledOneIsNone) {
  EXPECT_TRUE(histogramOf(Volume())->empty());
  Progress progress;
  progress.cancel();
  EXPECT_EQ(histogramOf(ramp(10), nullptr, progress).error().code.str(), "CANCELLED");
}

}  // namespace
}  // namespace trephine
