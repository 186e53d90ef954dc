#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "render/empty_space.h"

using namespace trephine;

namespace {

Volume air(Index3 size) {
  Volume volume;
  volume.geometry.size = size;
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  return volume;
}

void set(Volume& volume, int i, int j, int k, std::int16_t hu) {
  volume.hu[volume.geometry.indexOf(i, j, k)] = hu;
}

const std::vector<HuInterval> kBone = {{300.0, 3071.0}};

// By definition: bricks to the nearest brick in which, a voxel beyond its faces included, some HU
// between the lowest and the highest is visible.
std::vector<int> distancesByDefinition(const Volume& volume) {
  const Index3& n = volume.geometry.size;
  const Index3 b{(n[0] + 7) / 8, (n[1] + 7) / 8, (n[2] + 7) / 8};
  std::vector<Index3> seen;
  for (int k = 0; k < b[2]; ++k) {
    for (int j = 0; j < b[1]; ++j) {
      for (int i = 0; i < b[0]; ++i) {
        int low = 99999, high = -99999;
        for (int z = k * 8 - 1; z <= k * 8 + 8; ++z) {
          for (int y = j * 8 - 1; y <= j * 8 + 8; ++y) {
            for (int x = i * 8 - 1; x <= i * 8 + 8; ++x) {
              if (!volume.geometry.contains(x, y, z)) continue;
              low = std::min<int>(low, volume.at(x, y, z));
              high = std::max<int>(high, volume.at(x, y, z));
            }
          }
        }
        if (high >= 300 && low <= 3071) seen.push_back({i, j, k});
      }
    }
  }
  std::vector<int> distances;
  for (int k = 0; k < b[2]; ++k) {
    for (int j = 0; j < b[1]; ++j) {
      for (int i = 0; i < b[0]; ++i) {
        int nearest = 255;
        for (const Index3& s : seen) {
          nearest = std::min(
              nearest, std::max({std::abs(s[0] - i), std::abs(s[1] - j), std::abs(s[2] - k)}));
        }
        distances.push_back(nearest);
      }
    }
  }
  return distances;
}

}  // namespace

TEST(EmptySpace, DistancesAreThoseOfTheDefinition) {
  std::mt19937 random(3);
  Volume volume = air({75, 64, 50});  // not whole bricks
  for (int n = 0; n < 12; ++n) {
    set(volume, int(random() % 75), int(random() % 64), int(random() % 50), 900);
  }
  const BrickRanges bricks(volume);
  EXPECT_EQ(bricks.size(), (Index3{10, 8, 7}));
  const EmptySpaceDistance map(bricks, kBone, 0.0);
  const std::vector<int> expected = distancesByDefinition(volume);
  ASSERT_EQ(map.distances().size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(map.distances()[i], expected[i]) << i;
}

TEST(EmptySpace, AVolumeOfAirIsLeaptOverWhole) {
  const EmptySpaceDistance map(BrickRanges(air({40, 40, 40})), kBone, 0.0);
  for (std::uint8_t d : map.distances()) EXPECT_EQ(d, 255);
}

TEST(EmptySpace, AVoxelAtABricksRimCountsBesideItToo) {
  Volume volume = air({32, 8, 8});
  set(volume, 8, 4, 4, 900);
  const EmptySpaceDistance map(BrickRanges(volume), kBone, 0.0);
  EXPECT_EQ(map.distances(), (std::vector<std::uint8_t>{0, 0, 1, 2}));
}

TEST(EmptySpace, ValuesBetweenTwoVoxelsCount) {
  // Neither voxel is visible, but what is interpolated between them is.
  Volume volume = air({8, 8, 8});
  set(volume, 4, 4, 4, 2000);
  const BrickRanges bricks(volume);
  EXPECT_EQ(EmptySpaceDistance(bricks, {{300.0, 700.0}}, 0.0).distances()[0], 0);
  EXPECT_EQ(EmptySpaceDistance(bricks, {{2100.0, 3000.0}}, 0.0).distances()[0], 255);
  EXPECT_EQ(EmptySpaceDistance(bricks, {{2100.0, 3000.0}}, 101.0).distances()[0], 0);
}

TEST(EmptySpace, WhatIsVisibleUnderALabelCountsInBricksThatHaveIt) {
  const Volume volume = air({32, 8, 12});
  LabelMap labels{volume.geometry, std::vector<std::uint8_t>(volume.hu.size())};
  labels.labels[volume.geometry.indexOf(9, 3, 8)] = 5;
  labels.labels[volume.geometry.indexOf(31, 0, 0)] = 7;
  LabelRows rows;
  rows.count = 2;
  rows.row[5] = 1;
  BrickLabels known(volume.geometry.size);
  EXPECT_EQ(known.rows(rows), std::vector<std::uint32_t>(8, 1)) << "not looked at yet";
  known.update(labels, {{0, 0, 0}, volume.geometry.size});
  const std::vector<std::uint32_t> of_bricks = known.rows(rows);
  EXPECT_EQ(of_bricks, (std::vector<std::uint32_t>{1, 1, 1, 1, 1, 3, 1, 1}));
  const BrickRanges bricks(volume);
  const std::vector<HuInterval> air_too{{-1000.0, 1000.0}};
  EXPECT_EQ(EmptySpaceDistance(bricks, {kBone, air_too}, of_bricks, 0.0).distances(),
            (std::vector<std::uint8_t>{1, 1, 1, 2, 1, 0, 1, 2}));
  EXPECT_EQ(EmptySpaceDistance(bricks, {kBone, kBone}, of_bricks, 0.0).distances()[5], 255);
  // The label moves to another brick.
  EmptySpaceDistance leaps(bricks, {kBone, air_too}, of_bricks, 0.0);
  labels.labels[volume.geometry.indexOf(9, 3, 8)] = 0;
  labels.labels[volume.geometry.indexOf(17, 3, 8)] = 5;
  known.update(labels, {{9, 3, 8}, {18, 4, 9}});
  for (const std::size_t brick : {std::size_t(5), std::size_t(6)}) {
    leaps.setRows(brick, known.rowsOf(brick, rows));
  }
  leaps.update(bricks, {{1, 0, 1}, {3, 1, 2}});
  EXPECT_EQ(leaps.distances(), (std::vector<std::uint8_t>{2, 1, 1, 1, 2, 1, 0, 1}));
}

TEST(EmptySpace, AnUpdatedBoxEqualsAFreshLook) {
  std::mt19937 random(11);
  Volume volume = air({70, 60, 40});
  for (std::int16_t& hu : volume.hu) hu = std::int16_t(int(random() % 1500) - 1000);
  BrickRanges bricks(volume);
  for (int n = 0; n < 20; ++n) {
    VoxelBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int size = volume.geometry.size[axis];
      box.low[axis] = int(random() % unsigned(size));
      box.high[axis] = std::min(size, box.low[axis] + 1 + int(random() % 17));
    }
    for (int k = box.low[2]; k < box.high[2]; ++k) {
      for (int j = box.low[1]; j < box.high[1]; ++j) {
        for (int i = box.low[0]; i < box.high[0]; ++i) set(volume, i, j, k, kAirHu);
      }
    }
    bricks.update(volume, box);
    ASSERT_EQ(bricks.ranges(), BrickRanges(volume).ranges());
  }
}

TEST(EmptySpace, CutsAndUndosNeverMakeALeapTooLong) {
  std::mt19937 random(5);
  Volume volume = air({96, 96, 96});
  for (int k = 30; k < 66; ++k) {
    for (int j = 30; j < 66; ++j) {
      for (int i = 30; i < 66; ++i) set(volume, i, j, k, 900);
    }
  }
  BrickRanges bricks(volume);
  EmptySpaceDistance map(bricks, kBone, 0.0);
  for (int n = 0; n < 60; ++n) {
    VoxelBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = int(random() % 80);
      box.high[axis] = box.low[axis] + 16;
    }
    const std::int16_t hu = n % 3 == 2 ? std::int16_t(900) : kAirHu;
    for (int k = box.low[2]; k < box.high[2]; ++k) {
      for (int j = box.low[1]; j < box.high[1]; ++j) {
        for (int i = box.low[0]; i < box.high[0]; ++i) set(volume, i, j, k, hu);
      }
    }
    if (const auto changed = bricks.update(volume, box)) map.update(bricks, *changed);
    const std::vector<int> truth = distancesByDefinition(volume);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      ASSERT_LE(map.distances()[i], truth[i]);
      ASSERT_EQ(map.distances()[i] == 0, truth[i] == 0);
    }
  }
}
