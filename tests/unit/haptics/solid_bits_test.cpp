#include "haptics/solid_bits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "haptics/near_pieces.h"
#include "haptics_support.h"

namespace trephine {
namespace {

TEST(SolidBits, FindTheFirstSolidVoxelOfARowFromAnyPlaceToAnyOther) {
  const Index3 size{201, 3, 2};
  SolidBits bits(size);
  std::mt19937 random(5);
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) bits.set({i, j, k}, random() % (j == 0 ? 90 : 4) == 0);
    }
  }
  for (int n = 0; n < 20000; ++n) {
    const int j = int(random() % 3), k = int(random() % 2);
    const int from = int(random() % 201), to = int(random() % 201);
    int up = from, down = from;
    while (up <= to && !bits.at({up, j, k})) ++up;
    while (down >= to && !bits.at({down, j, k})) --down;
    ASSERT_EQ(bits.up(from, to, j, k), from > to ? to + 1 : up) << from << ' ' << to;
    ASSERT_EQ(bits.down(from, to, j, k), from < to ? to - 1 : down) << from << ' ' << to;
  }
  EXPECT_EQ(bits.bytes(), 4u * 8u * 6u) << "an eighth of a byte a voxel, rows of whole words";
}

// What a tool asks of a row is the same before and while the bits are made anew after an edit.
TEST(SolidBits, FollowWhatIsCutPutBackAndMeantByOtherTissues) {
  Grid grid(test::boneSlab());
  Grid::Writer writer = *grid.takeWriter();
  TissueTable table = test::boneTable();
  table.classes[0].solid = 1;
  TissueField tissue(grid, table);
  const GridGeometry& g = grid.geometry();
  const auto expectAll = [&](const char* when) {
    for (int k = 0; k < g.size[2]; ++k) {
      for (int j = 0; j < g.size[1]; ++j) {
        int first = 0;
        const auto solid = [&](int i) {
          return tissue.isSolid(tissue.classAt(g.indexOf(i, j, k)));
        };
        while (first < g.size[0] && !solid(first)) ++first;
        ASSERT_EQ(tissue.solidUp(0, g.size[0] - 1, j, k), first) << when;
        int last = g.size[0] - 1;
        while (last >= 0 && !solid(last)) --last;
        ASSERT_EQ(tissue.solidDown(g.size[0] - 1, 0, j, k), last) << when;
      }
    }
  };
  expectAll("at first");
  std::vector<std::size_t> cut;
  for (int n = 0; n < 300; ++n) {
    const Index3 at{n * 7 % g.size[0], n * 5 % g.size[1], n * 3 % g.size[2]};
    const std::size_t voxel = g.indexOf(at[0], at[1], at[2]);
    const int c = tissue.classAt(voxel);
    if (c < 0) continue;
    writer.store(voxel, kAirHu);
    tissue.removed(at, c);
    cut.push_back(voxel);
  }
  ASSERT_GT(cut.size(), 10u);
  expectAll("cut");
  for (std::size_t n = 0; n < cut.size(); n += 2) {
    writer.store(cut[n], test::kBoneHu);
    tissue.changed(cut[n]);
  }
  expectAll("put back in part");
  table.classes[0].solid = 0;
  (void)tissue.use(table);
  expectAll("nothing is solid");
  for (int n = 0; n < 3; ++n) tissue.recount();
  table.classes[0].solid = 1;
  (void)tissue.use(table);
  expectAll("it is again, and nothing is counted yet");
  while (tissue.unknownBricks() > 0) tissue.recount();
  expectAll("counted");
}

TEST(NearPieces, AreAllWithinReachInOrder) {
  std::mt19937 random(9);
  const auto in = [&](double from, double to) {
    return from + (to - from) * double(random()) / 4294967296.0;
  };
  NearPieces near(500);
  for (int round = 0; round < 20; ++round) {
    const std::size_t count = 1 + random() % 500;
    std::vector<Vec3> places;
    for (std::size_t n = 0; n < count; ++n) places.push_back({in(-3, 3), in(0, 9), in(5, 5.2)});
    near.clear({-3, 0, 5}, {3, 9, 5.2}, count);
    for (std::size_t n = 0; n < count; ++n) near.add(n, places[n]);
    for (int ask = 0; ask < 50; ++ask) {
      const Vec3 at(in(-4, 4), in(-1, 10), in(4, 6));
      const double reach = in(0.0, 1.5);
      std::vector<std::size_t> met;
      near.around(at, reach, [&](std::size_t n) { met.push_back(n); });
      EXPECT_TRUE(std::ranges::is_sorted(met));
      for (std::size_t n = 0; n < count; ++n) {
        if (glm::distance(places[n], at) > reach) continue;
        EXPECT_TRUE(std::ranges::binary_search(met, n));
      }
    }
  }
}

}  // namespace
}  // namespace trephine
