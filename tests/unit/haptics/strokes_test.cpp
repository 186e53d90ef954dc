// Strokes of any tool: a few of what strokes_slow_test.cpp has many of.
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

}  // namespace
}  // namespace trephine
