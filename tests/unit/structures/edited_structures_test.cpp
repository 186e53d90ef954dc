#include "structures/edited_structures.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "structures/grow_box.h"

namespace trephine {
namespace {

GridGeometry cube() {
  GridGeometry grid;
  grid.size = {10, 10, 10};
  grid.spacing_mm = Vec3(2.0);
  return grid;
}

// A liver of 20 voxels and a kidney of one.
std::shared_ptr<const LabelMap> given() {
  LabelMap map{cube(), std::vector<std::uint8_t>(1000)};
  std::fill_n(map.labels.begin(), 20, std::uint8_t(3));
  map.labels[500] = 7;
  map.structures = {{3, "liver", Vec3(1.0)}, {7, "kidney", Vec3(0.5)}};
  return std::make_shared<const LabelMap>(map);
}

class Edited : public testing::Test {
 protected:
  Edited() {
    edited_.start(given());
    EXPECT_TRUE(edited_.makeOwn(cube()).ok());
  }
  // Voxels from `first` on, as many as said, become of that label.
  LabelEdit paint(int label, std::size_t first, std::size_t count) {
    std::vector<std::uint8_t> mask(1000);
    for (std::size_t v = 0; v < mask.size(); ++v) mask[v] = edited_.map()->labels[v] == label;
    std::fill_n(mask.begin() + std::ptrdiff_t(first), count, std::uint8_t(1));
    return maskEdit(*edited_.map(), mask, label).value();
  }
  int made(const std::string& name, std::size_t first, std::size_t count) {
    const int label = edited_.freeLabel().value();
    edited_.addRow({label, name, Vec3(1.0)});
    edited_.put("make " + name, paint(label, first, count));
    return label;
  }
  double voxels(int label) { return edited_.millilitres(label) / 0.008; }

  EditedStructures edited_;
};

TEST_F(Edited, WhatWasGivenStaysAsItIsAndIsCounted) {
  const auto before = given();
  edited_.start(before);
  EXPECT_EQ(edited_.map(), before);
  EXPECT_NEAR(voxels(3), 20.0, 1e-9);
  ASSERT_TRUE(edited_.makeOwn(cube()).ok());
  EXPECT_NE(edited_.map(), before);
  edited_.put("more", paint(3, 100, 5));
  EXPECT_NEAR(voxels(3), 25.0, 1e-9);
  EXPECT_EQ(before->labels[100], 0);
}

TEST_F(Edited, EveryStepIsCountedUndoneAndDoneAgain) {
  const std::uint64_t before = edited_.version();
  const int label = made("spleen", 200, 8);
  const std::uint64_t after = edited_.version();
  EXPECT_NE(after, before);
  EXPECT_NEAR(voxels(label), 8.0, 1e-9);
  ASSERT_TRUE(edited_.undo());
  EXPECT_EQ(edited_.version(), before) << "they are again what they were";
  EXPECT_FALSE(edited_.hasVoxels(label));
  EXPECT_TRUE(edited_.find(label)) << "its row is there for redo";
  ASSERT_TRUE(edited_.redo());
  EXPECT_NEAR(voxels(label), 8.0, 1e-9);
  EXPECT_EQ(edited_.version(), after);
  EXPECT_FALSE(edited_.redo());
  EXPECT_EQ(edited_.version(), after);
  ASSERT_TRUE(edited_.undo());
  edited_.put("other", paint(7, 300, 4));
  EXPECT_NE(edited_.version(), after) << "another step is another version";
  EXPECT_NE(edited_.version(), before);
  const std::uint64_t other = edited_.version();
  edited_.recolour("same", 7, edited_.find(7)->colour);
  EXPECT_EQ(edited_.version(), other) << "nothing changed";
  edited_.start(given());
  EXPECT_NE(edited_.version(), before) << "another case, even with the same structures";
}

TEST_F(Edited, ANameOfWhatHasVoxelsIsTakenAndOneOfWhatHasNoneIsGivenAway) {
  EXPECT_EQ(edited_.freeName("Liver"), "Liver 2");
  EXPECT_FALSE(edited_.rename("Rename", 7, "liver"));
  edited_.put("Delete", edited_.removalOf(3).value());
  EXPECT_EQ(edited_.first(), 7);
  EXPECT_EQ(edited_.freeName("liver"), "liver");
  EXPECT_TRUE(edited_.rename("Rename", 7, "liver"));
  EXPECT_EQ(edited_.find(3)->name, "liver 2");
  edited_.undo();
  EXPECT_EQ(edited_.find(7)->name, "kidney");
}

TEST_F(Edited, WhatIsTriedOutCountsOnceItIsTaken) {
  const std::uint64_t before = edited_.version();
  const int label = edited_.freeLabel().value();
  edited_.addRow({label, "spleen", Vec3(1.0)});
  edited_.tryOut(paint(label, 200, 8), label);
  EXPECT_NEAR(voxels(label), 8.0, 1e-9);
  EXPECT_FALSE(edited_.toUndo());
  edited_.leaveTried();
  EXPECT_FALSE(edited_.find(label));
  EXPECT_EQ(edited_.map()->labels, given()->labels);
  EXPECT_EQ(edited_.version(), before);
  edited_.tryOut(paint(7, 200, 8), 0);
  edited_.takeTried("Grow kidney");
  EXPECT_NE(edited_.version(), before);
  EXPECT_EQ(*edited_.toUndo(), "Grow kidney");
  edited_.undo();
  EXPECT_NEAR(voxels(7), 1.0, 1e-9);
}

TEST_F(Edited, ALayerThatIsRemovedGoesBackToWhatItWasMadeOf) {
  const int layer = edited_.freeLabel().value();
  edited_.addRow({layer, "capsule", Vec3(1.0)});
  edited_.put("Shell", shellEdit(*edited_.map(), 3, 1.0, layer).value());
  edited_.noteLayer(layer, 3);
  ASSERT_LT(voxels(3), 20.0);
  edited_.put("Delete", edited_.removalOf(layer).value());
  EXPECT_NEAR(voxels(3), 20.0, 1e-9);
  EXPECT_FALSE(edited_.hasVoxels(layer));
}

TEST_F(Edited, TheWallIsOfNoCopyAndNothingOneWorksOn) {
  edited_.start(nullptr);
  ASSERT_TRUE(edited_.makeOwn(cube()).ok());
  const int wall = edited_.makeWall("wall", Vec3(0.9)).value();
  EXPECT_EQ(edited_.makeWall("wall", Vec3(0.9)).value(), wall);
  const std::uint64_t version = edited_.version();
  edited_.put("Brush", paint(wall, 0, 4));
  EXPECT_EQ(edited_.version(), version) << "no structure has changed";
  EXPECT_EQ(edited_.first(), 0);
  EXPECT_EQ(*edited_.withoutWall(), nullptr);
  made("spleen", 200, 8);
  EXPECT_NE(edited_.version(), version);
  const auto copy = *edited_.withoutWall();
  ASSERT_TRUE(copy);
  EXPECT_EQ(copy->structures.size(), 1u);
  EXPECT_EQ(std::ranges::count(copy->labels, std::uint8_t(wall)), 0);
  EXPECT_TRUE(edited_.overWall().test(std::size_t(wall)));
}

TEST_F(Edited, AWallBesideAStructureOfThatNameIsAnother) {
  edited_.rename("Rename", 7, "wall");
  const int wall = edited_.makeWall("wall", Vec3(0.9)).value();
  EXPECT_NE(wall, 7);
  EXPECT_EQ(edited_.find(wall)->name, "wall 2");
}

TEST_F(Edited, AMapHoldsNoMoreRowsThanLabelsCanTell) {
  while (edited_.map()->structures.size() < std::size_t(kMostStructures)) {
    const int label = edited_.freeLabel().value();
    edited_.addRow({label, "number " + std::to_string(label), Vec3(1.0)});
  }
  EXPECT_EQ(edited_.freeLabel().error().code.str(), "TOO_MANY_STRUCTURES");
  EXPECT_FALSE(edited_.makeWall("wall", Vec3(0.9)));
}

TEST(GrowBox, TakesTheSidesThatADragInASliceHas) {
  const VoxelBox all{{0, 0, 0}, {10, 10, 10}};
  const auto box = withSides(all, cube(), Vec3(13.0, 3.0, 8.0), Vec3(5.0, 99.0, 8.0), 2);
  ASSERT_TRUE(box);
  EXPECT_EQ(*box, (VoxelBox{{3, 2, 0}, {7, 10, 10}}));
  EXPECT_EQ(size_mm(*box, cube()), Vec3(8.0, 16.0, 20.0));
  EXPECT_TRUE(holds(*box, {3, 9, 0}));
  EXPECT_FALSE(holds(*box, {7, 9, 0}));
}

TEST(GrowBox, IsNoneBesideTheScanOrBetweenTwoVoxels) {
  const VoxelBox all{{0, 0, 0}, {10, 10, 10}};
  EXPECT_FALSE(withSides(all, cube(), Vec3(40.0, 3.0, 8.0), Vec3(50.0, 9.0, 8.0), 2));
  EXPECT_FALSE(withSides(all, cube(), Vec3(4.4, 3.0, 8.0), Vec3(5.4, 9.0, 8.0), 2));
}

}  // namespace
}  // namespace trephine
