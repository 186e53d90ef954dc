#include <gtest/gtest.h>

#include <random>

#include "render/dirty_boxes.h"

using namespace trephine;

namespace {

bool covers(const std::vector<VoxelBox>& boxes, const VoxelBox& wanted) {
  for (int k = wanted.low[2]; k < wanted.high[2]; k += 4) {
    for (int j = wanted.low[1]; j < wanted.high[1]; j += 4) {
      for (int i = wanted.low[0]; i < wanted.high[0]; i += 4) {
        bool found = false;
        for (const VoxelBox& b : boxes) {
          found = found || (i >= b.low[0] && j >= b.low[1] && k >= b.low[2] && i < b.high[0] &&
                            j < b.high[1] && k < b.high[2]);
        }
        if (!found) return false;
      }
    }
  }
  return true;
}

VoxelBox brick(int i, int j, int k) {
  return {{i * 16, j * 16, k * 16}, {i * 16 + 16, j * 16 + 16, k * 16 + 16}};
}

}  // namespace

TEST(DirtyBoxes, ABlockOfBricksBecomesOneBox) {
  std::vector<VoxelBox> bricks;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) bricks.push_back(brick(i, j, k));
    }
  }
  const auto merged = mergeBoxes(bricks);
  ASSERT_EQ(merged.size(), 1u);
  EXPECT_EQ(merged[0], (VoxelBox{{0, 0, 0}, {48, 48, 48}}));
}

TEST(DirtyBoxes, TheSameBoxTwiceIsSentOnce) {
  EXPECT_EQ(mergeBoxes({brick(1, 2, 3), brick(1, 2, 3)}).size(), 1u);
}

TEST(DirtyBoxes, TwoFarCutsStayTwoBoxes) {
  const auto merged = mergeBoxes({brick(0, 0, 0), brick(30, 30, 15)});
  ASSERT_EQ(merged.size(), 2u);
  EXPECT_EQ(voxelCount(merged[0]) + voxelCount(merged[1]), 2u * 16 * 16 * 16);
}

TEST(DirtyBoxes, NothingIsLostHoweverManyBoxesThereAre) {
  std::mt19937 random(7);
  std::vector<VoxelBox> bricks;
  for (int n = 0; n < 800; ++n) {
    bricks.push_back(brick(int(random() % 32), int(random() % 32), int(random() % 16)));
  }
  const auto merged = mergeBoxes(bricks, 32);
  EXPECT_LE(merged.size(), 32u);
  for (const VoxelBox& b : bricks) ASSERT_TRUE(covers(merged, b));
}

TEST(DirtyBoxes, AnEmptyBoxIsNothing) {
  EXPECT_TRUE(mergeBoxes({VoxelBox{{3, 3, 3}, {3, 9, 9}}}).empty());
}
