#include <gtest/gtest.h>

#include <random>

#include "render/label_shape.h"

namespace trephine {
namespace {

LabelMap scattered(const Index3& size, double share) {
  LabelMap map;
  map.geometry.size = size;
  map.geometry.spacing_mm = Vec3(1.0);
  std::mt19937 random(3);
  for (std::size_t i = 0; i < map.geometry.voxelCount(); ++i) {
    const bool none = double(random()) / double(random.max()) > share;
    map.labels.push_back(std::uint8_t(none ? 0 : 4 + random() % 3));
  }
  return map;
}

template <class LabelAt>
void expectShapes(const LabelMap& map, const VoxelBox& box, const LabelAt& label) {
  LabelShapes shapes(map, box);
  for (int k = box.low[2]; k < box.high[2]; ++k) {
    ASSERT_FALSE(shapes.done());
    EXPECT_EQ(shapes.slice(), k);
    const std::vector<LabelShape>& slice = shapes.next();
    std::size_t v = 0;
    for (int j = box.low[1]; j < box.high[1]; ++j) {
      for (int i = box.low[0]; i < box.high[0]; ++i, ++v) {
        int of_64 = 0, nearest = 0;
        for (int n = 0; n < 27; ++n) {
          const int di = n % 3 - 1, dj = n / 3 % 3 - 1, dk = n / 9 - 1;
          const int there = label(i + di, j + dj, k + dk);
          nearest = std::max(nearest, there);
          if (there) of_64 += (2 - std::abs(di)) * (2 - std::abs(dj)) * (2 - std::abs(dk));
        }
        const int own = label(i, j, k), inside = of_64 * 255 / 64;
        EXPECT_EQ(int(slice[v].label), own ? own : nearest);
        EXPECT_EQ(int(slice[v].inside), own ? std::max(inside, 128) : std::min(inside, 127));
      }
    }
  }
  EXPECT_TRUE(shapes.done());
}

TEST(LabelShapes, AreTheShareOfLabelledNeighboursNearerOnesWeighingMore) {
  for (const Index3& size : {Index3{7, 6, 5}, Index3{5, 4, 1}, Index3{1, 1, 1}, Index3{9, 1, 3}}) {
    const LabelMap map = scattered(size, 0.4);
    const auto label = [&](int i, int j, int k) {
      return map.geometry.contains(i, j, k) ? int(map.labels[map.geometry.indexOf(i, j, k)]) : 0;
    };
    // All of it, and a part.
    for (const VoxelBox& box :
         {VoxelBox{{0, 0, 0}, size}, VoxelBox{{size[0] / 2, 0, size[2] / 2}, size},
          VoxelBox{{0, 0, 0}, {1, (size[1] + 1) / 2, 1}}}) {
      expectShapes(map, box, label);
    }
  }
}
TEST(LabelShapes, AreExactAtVoxelCentresHoweverThinAStructureIs) {
  LabelMap map = scattered({9, 9, 9}, 0.0);
  map.labels[map.geometry.indexOf(4, 4, 4)] = 5;
  LabelShapes shapes(map, {{0, 0, 0}, map.geometry.size});
  int inside = 0;
  for (int k = 0; k < 9; ++k) {
    for (const LabelShape& shape : shapes.next()) inside += shape.inside > 127;
  }
  EXPECT_EQ(inside, 1);
}

}  // namespace
}  // namespace trephine
