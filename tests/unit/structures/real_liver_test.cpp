// A real liver from one click, and mended by strokes at places that can be seen in its slices. They
// were chosen with the truth at hand.
#include <gtest/gtest.h>

#include <cstdio>

#include "liver_case.h"
#include "structures/grow.h"
#include "structures/shape_tools.h"
#include "support.h"

namespace trephine {
namespace {

TEST(RealLiver, IsFoundByAClickAndRightAfterThreeStrokes) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const test::LiverCase of = test::realLiver(data);
  const auto growth = grow(of.volume, Vec3(-92.0, -161.0, 406.0));
  ASSERT_TRUE(growth) << growth.error().sentence();
  LabelMap map = growth->mask;
  const auto dice = [&](const char* step) {
    const Likeness like = of.against(map);
    std::printf("%-56s Dice %.3f, hd95 %.1f mm\n", step, like.dice, like.hd95_mm);
    return like.dice;
  };
  const auto stroke = [&](const std::vector<Vec3>& path_mm, double radius_mm, bool erase) {
    Brush brush;
    brush.radius_mm = radius_mm;
    brush.erase = erase;
    if (!erase) brush.hu = HuSpan{0.0, 84.0};  // neither lung nor fat nor rib
    const auto edit = brushEdit(map, 1, path_mm, brush, &of.volume);
    ASSERT_TRUE(edit) << edit.error().sentence();
    EXPECT_FALSE(edit->empty());
    apply(map, *edit);
  };
  EXPECT_GE(dice("a click"), 0.88);

  // Below the diaphragm, right behind: the darker liver there is left out in a crescent.
  stroke({{-77, -105, 388},
          {-70, -106, 400},
          {-60, -118, 404},
          {-72, -105, 405},
          {-105, -97, 409},
          {-85, -103, 414}},
         11.0, false);
  dice("painted: the crescent below the diaphragm, behind");
  // A round vessel in front of the spine, from slice to slice.
  stroke({{-18, -170, 394}, {-16, -166, 406}, {-10, -162, 415}, {-9, -158, 427}}, 9.0, true);
  dice("erased: the vena cava");
  // Muscle between two ribs, outside of the curve of the liver.
  stroke({{-150, -150, 376}, {-150, -158, 388}, {-148, -162, 400}}, 8.0, true);
  EXPECT_GE(dice("erased: the muscle between the ribs, at the side"), 0.935);
}

}  // namespace
}  // namespace trephine
