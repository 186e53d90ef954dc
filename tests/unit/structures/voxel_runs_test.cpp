#include "structures/voxel_runs.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace trephine {
namespace {

// Characters that are in, layer after layer of rows.
VoxelRuns runsOf(const Index3& size, const std::vector<std::string>& rows) {
  return VoxelRuns(size, [&](int i, int j, int k) {
    return rows[std::size_t(k * size[1] + j)][std::size_t(i)] == '#';
  });
}

TEST(VoxelRuns, HangTogetherAcrossFacesOrCornersAsAsked) {
  VoxelRuns runs = runsOf({4, 2, 2}, {"#...",  //
                                      ".#..",
                                      "..#.",  //
                                      "...."});
  runs.join(Touching::corners);
  ASSERT_EQ(runs.pieces().size(), 1u);
  EXPECT_EQ(runs.pieces()[0].voxels, 3u);
  runs.join(Touching::faces);
  EXPECT_EQ(runs.pieces().size(), 3u);
}

TEST(VoxelRuns, OfOneLayerKnowNothingOfTheNext) {
  VoxelRuns runs = runsOf({3, 3, 2}, {"...", ".#.", "...",  //
                                      "...", ".##", "..."});
  runs.join(Touching::faces);
  EXPECT_EQ(runs.pieces().size(), 1u);
  EXPECT_TRUE(runs.pieces()[0].at_border);
  runs.join(Touching::faces_in_layer);
  ASSERT_EQ(runs.pieces().size(), 2u);
  EXPECT_FALSE(runs.pieces()[0].at_border);
  EXPECT_TRUE(runs.pieces()[1].at_border);
}

TEST(VoxelRuns, TellWhichPieceAVoxelIsOf) {
  VoxelRuns runs = runsOf({7, 1, 1}, {"##..#.#"});
  runs.join(Touching::faces);
  EXPECT_EQ(runs.at({1, 0, 0})->piece, 0u);
  EXPECT_EQ(runs.at({2, 0, 0}), nullptr);
  EXPECT_EQ(runs.at({4, 0, 0})->piece, 1u);
  EXPECT_EQ(runs.at({6, 0, 0})->piece, 2u);
  EXPECT_EQ(runs.largest(), 0u);
}

// Against a flood that asks every neighbour of every voxel.
TEST(VoxelRuns, FindThePiecesThatAFloodFinds) {
  const Index3 size{13, 11, 9};
  GridGeometry g;
  g.size = size;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    std::vector<std::uint8_t> in(g.voxelCount());
    for (auto& voxel : in) voxel = random() % 100 < 5 + 2 * seed;
    for (const Touching touching : {Touching::faces, Touching::corners, Touching::faces_in_layer}) {
      VoxelRuns runs(size, [&](int i, int j, int k) { return in[g.indexOf(i, j, k)] != 0; });
      runs.join(touching);
      std::vector<int> piece(in.size(), -1);
      int count = 0;
      for (std::size_t start = 0; start < in.size(); ++start) {
        if (!in[start] || piece[start] >= 0) continue;
        std::vector<std::size_t> open{start};
        piece[start] = count;
        std::size_t voxels = 0;
        while (!open.empty()) {
          const Index3 at = g.indicesOf(open.back());
          open.pop_back();
          ++voxels;
          for (int n = 0; n < 27; ++n) {
            const int a = n % 3 - 1, b = n / 3 % 3 - 1, c = n / 9 - 1;
            const int far = std::abs(a) + std::abs(b) + std::abs(c);
            if (touching != Touching::corners && far != 1) continue;
            if (touching == Touching::faces_in_layer && c != 0) continue;
            if (!g.contains(at[0] + a, at[1] + b, at[2] + c)) continue;
            const std::size_t next = g.indexOf(at[0] + a, at[1] + b, at[2] + c);
            if (!in[next] || piece[next] >= 0) continue;
            piece[next] = count;
            open.push_back(next);
          }
        }
        ASSERT_EQ(runs.pieces()[std::size_t(count)].voxels, voxels);
        ++count;
      }
      ASSERT_EQ(runs.pieces().size(), std::size_t(count));
      for (std::size_t n = 0; n < in.size(); ++n) {
        const VoxelRuns::Run* run = runs.at(g.indicesOf(n));
        ASSERT_EQ(run ? int(run->piece) : -1, piece[n]);
      }
    }
  }
}

}  // namespace
}  // namespace trephine
