#include <gtest/gtest.h>

#include "volume/volume_mirror.h"

using namespace trephine;

namespace {

Volume block() {
  Volume volume;
  volume.geometry.size = {40, 36, 20};
  volume.hu.assign(volume.geometry.voxelCount(), 700);
  return volume;
}

void cut(Grid& grid, int i, int j, int k) {
  grid.takeWriter()->store(i, j, k, kAirHu);
}

class VolumeMirrorTest : public testing::Test {
 protected:
  VolumeMirrorTest() { mirror_->show(block(), nullptr); }
  Grid grid_{block()};
  std::shared_ptr<VolumeMirror> mirror_ = std::make_shared<VolumeMirror>();
};

TEST_F(VolumeMirrorTest, ACutReachesEveryReaderOnce) {
  VolumeMirror::Reader first(mirror_), second(mirror_);
  EXPECT_TRUE(first.take().all) << "all is new to a new reader";
  EXPECT_FALSE(first.take().any());
  second.take();
  EXPECT_FALSE(mirror_->pull(grid_));

  cut(grid_, 20, 3, 18);
  ASSERT_TRUE(mirror_->pull(grid_));
  EXPECT_EQ(mirror_->volume().at(20, 3, 18), kAirHu);
  const VolumeMirror::News news = first.take();
  EXPECT_FALSE(news.all);
  ASSERT_EQ(news.boxes.size(), 1u);
  EXPECT_EQ(news.boxes[0], (VoxelBox{{16, 0, 16}, {32, 16, 20}}));
  EXPECT_FALSE(first.take().any());

  cut(grid_, 0, 0, 0);
  mirror_->pull(grid_);
  EXPECT_EQ(first.take().boxes.size(), 1u);
  EXPECT_EQ(second.take().boxes.size(), 2u) << "one that did not read misses nothing";
}

TEST_F(VolumeMirrorTest, OtherLabelsAndBoxesOfThemReachEveryReaderOnce) {
  VolumeMirror::Reader reader(mirror_);
  reader.take();
  const Volume whole = block();
  auto labels = std::make_shared<LabelMap>(
      LabelMap{whole.geometry, std::vector<std::uint8_t>(whole.hu.size())});
  mirror_->labelsChanged({{1, 1, 1}, {2, 2, 2}});
  mirror_->setLabels(labels);
  VolumeMirror::News news = reader.take();
  EXPECT_FALSE(news.all);
  EXPECT_TRUE(news.other_labels);
  EXPECT_TRUE(news.label_boxes.empty()) << "all of them are new";
  mirror_->setLabels(labels);
  EXPECT_FALSE(reader.take().any()) << "they are the same";
  mirror_->labelsChanged({{1, 1, 1}, {2, 2, 2}});
  news = reader.take();
  EXPECT_TRUE(news.any());
  EXPECT_EQ(news.label_boxes, (std::vector<VoxelBox>{{{1, 1, 1}, {2, 2, 2}}}));
  EXPECT_FALSE(reader.take().any());
}

TEST_F(VolumeMirrorTest, ItKnowsWhatWasTouchedSinceItWasWholeWhileTheWholeIsKept) {
  auto whole = std::make_shared<const Volume>(block());
  mirror_->show(block(), nullptr, whole);
  EXPECT_EQ(mirror_->whole(), whole);
  EXPECT_EQ(mirror_->touched(), VoxelBox{});
  cut(grid_, 20, 3, 18);
  mirror_->pull(grid_);
  EXPECT_EQ(mirror_->touched(), (VoxelBox{{16, 0, 16}, {32, 16, 20}}));
  cut(grid_, 0, 20, 0);
  mirror_->pull(grid_);
  EXPECT_EQ(mirror_->touched(), (VoxelBox{{0, 0, 0}, {32, 32, 20}}));
  mirror_->refill(slabsOf(*whole), nullptr, whole);
  EXPECT_EQ(mirror_->touched(), VoxelBox{});
  whole = nullptr;
  EXPECT_EQ(mirror_->whole(), nullptr) << "the mirror keeps no second copy alive";
  mirror_->show(block(), nullptr, std::make_shared<const Volume>());
  EXPECT_EQ(mirror_->whole(), nullptr) << "of another place";
}

TEST_F(VolumeMirrorTest, AReaderThatNeverReadsKeepsABoxThatHoldsAllOfThem) {
  VolumeMirror::Reader reader(mirror_);
  reader.take();
  for (int n = 0; n < 5000; ++n) {
    cut(grid_, n % 2 * 39, 3, 3);
    mirror_->pull(grid_);
  }
  const VolumeMirror::News news = reader.take();
  EXPECT_LE(news.boxes.size(), 4096u);
  Index3 low = news.boxes[0].low, high = news.boxes[0].high;
  for (const VoxelBox& box : news.boxes) {
    low[0] = std::min(low[0], box.low[0]);
    high[0] = std::max(high[0], box.high[0]);
  }
  EXPECT_EQ(low[0], 0);
  EXPECT_EQ(high[0], 40);
}

TEST_F(VolumeMirrorTest, WhatIsShownAnewIsNewAsAWhole) {
  VolumeMirror::Reader reader(mirror_);
  reader.take();
  cut(grid_, 1, 1, 1);
  mirror_->pull(grid_);
  const std::int16_t* before = mirror_->volume().hu.data();
  const Volume whole = block();
  mirror_->refill(slabsOf(whole), nullptr);
  EXPECT_EQ(mirror_->volume().hu.data(), before) << "filling again takes no further memory";
  EXPECT_EQ(mirror_->volume().hu, whole.hu);
  const VolumeMirror::News news = reader.take();
  EXPECT_TRUE(news.all);
  EXPECT_TRUE(news.boxes.empty());
}

TEST_F(VolumeMirrorTest, VoxelsOfAnotherPlaceAreNotTaken) {
  VolumeMirror::Reader reader(mirror_);
  reader.take();
  Volume other = block();
  other.geometry.origin_mm.x = 1.0;
  other.hu.assign(other.hu.size(), 5);
  mirror_->refill(slabsOf(other), nullptr);
  Grid moved(other);
  cut(moved, 1, 1, 1);
  EXPECT_FALSE(mirror_->pull(moved));
  EXPECT_FALSE(reader.take().any());
  EXPECT_EQ(mirror_->volume().hu, block().hu);
}

}  // namespace
