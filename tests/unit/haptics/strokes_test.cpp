// Strokes of any tool: a few of what strokes_slow_test.cpp has many of.
#include "slots_support.h"
#include "strokes_support.h"

namespace trephine {
namespace {

TEST(Stroke, TakesNoMoreThanMotorAndHandPaidFor) {
  for (unsigned seed = 1; seed <= 8; ++seed) EXPECT_TRUE(test::expectPaid(seed)) << seed;
}

TEST(Stroke, OfABurrTakesTheSameByAnyArm) {
  test::expectSameByAnyArm(test::triedTools()[0], 0.5);
}

TEST(Stroke, OfABladeInLiverTakesTheSameByAnyArm) {
  test::expectSameByAnyArm(test::triedTools()[3], 0.5);
}

TEST(Stroke, TakesTheSameAtFiveHundredHertzAndAtTwoThousand) {
  for (std::size_t n : {0u, 3u})
    test::expectSameAtAnyRate(test::triedTools()[n], 0.8, {500.0, 2000.0});
}

// A blade thinner than the diagonal of a voxel was held by the rows beside its slot, and erased
// them: 1.7 times the slot.
TEST(Slot, OfADrivenBladeThinnerThanAVoxelIsAsWideAsTheBlade) {
  const test::DrivenTool blade = test::drivenTools()[0];
  for (const Vec3& spacing_mm : {Vec3(0.8, 0.8, 1.0), Vec3(1.0)}) {
    const test::Slots slots = test::randomSlots(blade.tool, spacing_mm, 6);
    EXPECT_NEAR(slots.mean, 1.0, 0.15) << spacing_mm.x << " mm";
  }
}

}  // namespace
}  // namespace trephine
