#include <gtest/gtest.h>

#include "volume/cut_structures.h"

namespace trephine {
namespace {

// 10 x 10 x 10 voxels of 2 mm, so 0.008 mL each.
Volume block() {
  GridGeometry g;
  g.size = {10, 10, 10};
  g.spacing_mm = Vec3(2.0);
  return {g, Voxels(1000, 50)};
}

LabelMap halves() {
  LabelMap map{block().geometry, std::vector<std::uint8_t>(1000)};
  for (std::size_t i = 0; i < 1000; ++i) map.labels[i] = i < 500 ? 3 : i < 900 ? 1 : 0;
  map.structures = {{1, "vessel", Vec3(1.0)}, {2, "nowhere", Vec3(1.0)}, {3, "liver", Vec3(1.0)}};
  return map;
}

TEST(CutStructures, AreCountedInMlOfWhatEachHadAndInTheMapsOrder) {
  const Volume before = block();
  Grid grid{Volume(before)};
  {
    auto writer = grid.takeWriter();
    for (std::size_t i = 490; i < 510; ++i) writer->store(i, kAirHu);
    writer->store(950, kAirHu);  // of none of them
    writer->store(600, kAirHu);
    writer->store(600, 50);  // and put back
  }
  const auto rows = cutStructures(halves(), before, grid);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].name, "vessel");
  EXPECT_NEAR(rows[0].ml, 3.2, 1e-9);
  EXPECT_NEAR(rows[0].cut_ml, 0.08, 1e-9);
  EXPECT_EQ(rows[1].name, "liver");
  EXPECT_NEAR(rows[1].ml, 4.0, 1e-9);
  EXPECT_NEAR(rows[1].cut_ml, 0.08, 1e-9);
}

TEST(CutStructures, OfAnotherGridAreNone) {
  LabelMap map = halves();
  map.labels.pop_back();
  EXPECT_TRUE(cutStructures(map, block(), Grid(block())).empty());
}

TEST(CutStructures, AreSaidInWordsWhereTheyWereCut) {
  const std::vector<CutStructure> rows{
      {"liver", 1450.2, 3.24}, {"vessel", 31.0, 0.0}, {"tumour", 4.256, 0.126}};
  EXPECT_EQ(linesOf(rows), (std::vector<std::string>{"liver: 3.2 mL of 1450 mL cut",
                                                     "tumour: 0.13 mL of 4.26 mL cut"}));
}

}  // namespace
}  // namespace trephine
