#include "structures/work_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace trephine {
namespace {

WorkGrid gridOf(const Index3& size, const Vec3& block_mm) {
  WorkGrid grid;
  grid.size = size;
  grid.block_mm = block_mm;
  return grid;
}

std::vector<float> byTrial(const BlockMask& in, const WorkGrid& grid) {
  std::vector<float> mm;
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        double nearest = std::numeric_limits<double>::infinity();
        for (int z = 0; z < grid.size[2]; ++z) {
          for (int y = 0; y < grid.size[1]; ++y) {
            for (int x = 0; x < grid.size[0]; ++x) {
              if (!in[grid.indexOf(x, y, z)]) continue;
              nearest = std::min(nearest, glm::length(Vec3(x - i, y - j, z - k) * grid.block_mm));
            }
          }
        }
        mm.push_back(float(nearest));
      }
    }
  }
  return mm;
}

TEST(Distance, IsThatOfTheNearestBlockAlsoWhereBlocksAreNoCubes) {
  const WorkGrid grid = gridOf({13, 9, 11}, Vec3(1.0, 2.5, 0.7));
  std::mt19937 random(3);
  for (const unsigned sparse : {2u, 20u, 400u}) {
    BlockMask in(grid.count());
    for (auto& block : in) block = random() % sparse == 0;
    in[5] = 1;
    const std::vector<float> expected = byTrial(in, grid), mm = distance_mm(in, grid);
    for (std::size_t n = 0; n < mm.size(); ++n) EXPECT_NEAR(mm[n], expected[n], 1e-4) << n;
  }
}

TEST(Distance, ToNothingIsEndless) {
  const WorkGrid grid = gridOf({4, 5, 6}, Vec3(1.0));
  for (const float mm : distance_mm(BlockMask(grid.count()), grid)) EXPECT_TRUE(std::isinf(mm));
}

TEST(Pieces, ShareFacesAndAreNumberedBySize) {
  const WorkGrid grid = gridOf({6, 3, 3}, Vec3(1.0));
  BlockMask in(grid.count());
  for (const int i : {0, 1}) in[grid.indexOf(i, 1, 1)] = 1;
  for (const int i : {3, 4, 5}) in[grid.indexOf(i, 1, 1)] = 1;
  in[grid.indexOf(2, 0, 0)] = 1;  // across edges and corners only
  const auto piece = pieces(in, grid);
  EXPECT_EQ(piece[grid.indexOf(4, 1, 1)], 1);
  EXPECT_EQ(piece[grid.indexOf(0, 1, 1)], 2);
  EXPECT_EQ(piece[grid.indexOf(2, 0, 0)], 3);
  EXPECT_EQ(piece[grid.indexOf(2, 1, 1)], 0);
}

TEST(Holes, AreFilledButNoBay) {
  const WorkGrid grid = gridOf({7, 7, 7}, Vec3(1.0));
  BlockMask in(grid.count());
  for (int k = 1; k < 6; ++k) {
    for (int j = 1; j < 6; ++j) {
      for (int i = 1; i < 6; ++i) in[grid.indexOf(i, j, k)] = 1;
    }
  }
  in[grid.indexOf(3, 3, 3)] = 0;
  in[grid.indexOf(1, 3, 3)] = 0;
  fillHoles(in, grid);
  EXPECT_EQ(in[grid.indexOf(3, 3, 3)], 1);
  EXPECT_EQ(in[grid.indexOf(1, 3, 3)], 0);
  EXPECT_EQ(in[grid.indexOf(0, 0, 0)], 0);
}

TEST(Opening, CutsWhatIsNarrowerThanTheBall) {
  const WorkGrid grid = gridOf({40, 15, 15}, Vec3(2.0, 3.0, 3.0));
  BlockMask in(grid.count());
  const auto ball = [&](int i, int j, int k, int middle) {
    return glm::length(Vec3(i - middle, j - 7, k - 7) * grid.block_mm) <= 12.0;
  };
  for (int k = 0; k < 15; ++k) {
    for (int j = 0; j < 15; ++j) {
      for (int i = 0; i < 40; ++i) {
        const bool bridge = j == 7 && k == 7 && i > 8 && i < 31;
        in[grid.indexOf(i, j, k)] = ball(i, j, k, 8) || ball(i, j, k, 31) || bridge;
      }
    }
  }
  EXPECT_EQ(pieces(in, grid)[grid.indexOf(31, 7, 7)], 1);
  const BlockMask open = dilated(eroded(in, grid, 5.0), grid, 5.0);
  const auto piece = pieces(open, grid);
  EXPECT_NE(piece[grid.indexOf(8, 7, 7)], piece[grid.indexOf(31, 7, 7)]);
  EXPECT_EQ(open[grid.indexOf(20, 7, 7)], 0);
}

TEST(BlockMeans, AreOfTheVoxelsThereAreAndNoiseIsTheirs) {
  Volume volume;
  volume.geometry.size = {61, 50, 31};
  volume.geometry.spacing_mm = Vec3(1.0, 1.5, 3.0);
  std::mt19937 random(7);
  std::normal_distribution<double> noise(40.0, 30.0);
  volume.hu.resize(volume.geometry.voxelCount());
  for (auto& hu : volume.hu) hu = std::int16_t(std::lround(noise(random)));
  const WorkGrid grid = workGridOf(volume.geometry);
  EXPECT_EQ(grid.factor, (Index3{3, 2, 1}));
  EXPECT_EQ(grid.size, (Index3{21, 25, 31}));
  const Blocks means = blockMeans(volume, grid);
  double sum = 0.0;  // the last block along i is one voxel wide
  for (const int j : {4, 5}) sum += volume.at(60, j, 8);
  EXPECT_NEAR(means[grid.indexOf(20, 2, 8)], sum / 2.0, 1e-4);
  // Six voxels a block.
  EXPECT_NEAR(softTissueNoise_HU(means, grid), 30.0 / std::sqrt(6.0), 0.8);
}

TEST(Smoothing, LeavesTheMeanAndTakesTheNoise) {
  const WorkGrid grid = gridOf({30, 30, 30}, Vec3(3.0));
  std::mt19937 random(9);
  std::normal_distribution<float> noise(50.0f, 20.0f);
  Blocks blocks(grid.count());
  for (auto& hu : blocks) hu = noise(random);
  const Blocks smooth = smoothed(blocks, grid, 3.0);
  double sum = 0.0, squares = 0.0;
  for (const float hu : smooth) {
    sum += hu;
    squares += (hu - 50.0) * (hu - 50.0);
  }
  EXPECT_NEAR(sum / double(smooth.size()), 50.0, 0.5);
  EXPECT_LT(std::sqrt(squares / double(smooth.size())), 5.0);
}

}  // namespace
}  // namespace trephine
