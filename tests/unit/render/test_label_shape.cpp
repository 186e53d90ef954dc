#include <gtest/gtest.h>

#include <random>

#include "render/label_shape.h"

namespace trephine {
namespace {

LabelRows rowsOf(std::initializer_list<int> labels) {
  TissueTable table;
  for (const int label : labels) table.classes[std::size_t(table.count++)].label = label;
  return LabelRows(table);
}

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

TEST(LabelShapes, AreTheShareOfLabelledNeighboursNearerOnesWeighingMore) {
  const LabelRows rows = rowsOf({4, 5});  // 6 has no row of its own
  for (const Index3& size : {Index3{7, 6, 5}, Index3{5, 4, 1}, Index3{1, 1, 1}, Index3{9, 1, 3}}) {
    const LabelMap map = scattered(size, 0.4);
    const auto row = [&](int i, int j, int k) {
      return map.geometry.contains(i, j, k)
                 ? int(rows.row[map.labels[map.geometry.indexOf(i, j, k)]])
                 : 0;
    };
    LabelShapes shapes(map, rows);
    for (int k = 0; k < size[2]; ++k) {
      const std::vector<LabelShape>& slice = shapes.next();
      for (int j = 0; j < size[1]; ++j) {
        for (int i = 0; i < size[0]; ++i) {
          int of_64 = 0, nearest = 0;
          for (int n = 0; n < 27; ++n) {
            const int di = n % 3 - 1, dj = n / 3 % 3 - 1, dk = n / 9 - 1;
            const int there = row(i + di, j + dj, k + dk);
            nearest = std::max(nearest, there);
            if (there) of_64 += (2 - std::abs(di)) * (2 - std::abs(dj)) * (2 - std::abs(dk));
          }
          const LabelShape& shape = slice[std::size_t(j * size[0] + i)];
          const int own = row(i, j, k), inside = of_64 * 255 / 64;
          EXPECT_EQ(int(shape.row), own ? own : nearest);
          EXPECT_EQ(int(shape.inside), own ? std::max(inside, 128) : std::min(inside, 127));
        }
      }
    }
  }
}

TEST(LabelShapes, AreExactAtVoxelCentresHoweverThinAStructureIs) {
  LabelMap map = scattered({9, 9, 9}, 0.0);
  map.labels[map.geometry.indexOf(4, 4, 4)] = 5;
  const LabelRows rows = rowsOf({5});
  LabelShapes shapes(map, rows);
  int inside = 0;
  for (int k = 0; k < 9; ++k) {
    for (const LabelShape& shape : shapes.next()) inside += shape.inside > 127;
  }
  EXPECT_EQ(inside, 1);
}

}  // namespace
}  // namespace trephine
