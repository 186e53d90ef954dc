#include "haptics/swept_solid.h"

#include <gtest/gtest.h>

#include <random>

namespace trephine {
namespace {

double distance(const Vec3& p, const Capsule& c) {
  const Vec3 axis = c.to - c.from;
  const double length2 = glm::dot(axis, axis);
  const double t = length2 > 0.0 ? glm::dot(p - c.from, axis) / length2 : 0.0;
  return glm::length(p - c.from - glm::clamp(t, 0.0, 1.0) * axis);
}

// Points on either side of the ends of a row, and inside it, against the distance itself.
TEST(SweptSolid, ARowHoldsWhatLiesWithinTheRadiusAndNothingElse) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-5.0, 5.0);
  int rows = 0;
  for (int n = 0; n < 20000; ++n) {
    Capsule c{{any(random), any(random), any(random)}, {any(random), any(random), any(random)}, 1.5};
    if (n % 3 == 0) c.to = c.from;
    if (n % 7 == 0) c.to = c.from + Vec3(any(random), 0, 0);
    const double y = any(random), z = any(random);
    const Interval row = rowWithin(c, y, z);
    if (row.empty()) {
      for (double x = -8; x <= 8; x += 0.25) ASSERT_GT(distance({x, y, z}, c), 1.5 - 1e-9);
      continue;
    }
    ++rows;
    ASSERT_NEAR(distance({row.low, y, z}, c), 1.5, 1e-6);
    ASSERT_NEAR(distance({row.high, y, z}, c), 1.5, 1e-6);
    ASSERT_LE(distance({0.5 * (row.low + row.high), y, z}, c), 1.5 + 1e-9);
    const Interval band = bandWithin(c, z);
    ASSERT_LE(band.low, y + 1e-9);
    ASSERT_GE(band.high, y - 1e-9);
  }
  EXPECT_GT(rows, 2500);
}

TEST(SweptSolid, HoldsAllThatTheCapsulePassesWithinAThirtiethOfItsRadius) {
  const Capsule from{{0, 0, 0}, {0, 0, 4}, 1.0}, to{{3, 1, 0}, {3, 1, 5}, 1.0};
  const SweptSolid solid(from, to);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-2.0, 6.0);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p(any(random), any(random), any(random));
    double nearest = 1e9;
    for (int step = 0; step <= 100; ++step) {
      const double t = 0.01 * step;
      const Capsule at{from.from + t * (to.from - from.from), from.to + t * (to.to - from.to), 1.0};
      nearest = std::min(nearest, distance(p, at));
    }
    const Interval row = solid.row(p.y, p.z);
    const bool held = !row.empty() && p.x >= row.low && p.x <= row.high;
    // The first place was passed before.
    if (nearest < 1.0 - 1.0 / 30 && distance(p, from) > 1.0) {
      ASSERT_TRUE(held) << n;
    } else if (nearest > 1.0 + 1e-3) {
      ASSERT_FALSE(held) << n;
    }
  }
}

}  // namespace
}  // namespace trephine
