#include "haptics/nearest_motion.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace trephine {
namespace {

constexpr double kTurn_mm2 = 600.0;

double open_mm(const NearTouch& touch, const SmallMotion& motion) {
  return touch.gap_mm + glm::dot(touch.normal, motion.shift_mm) +
         glm::dot(touch.moment, motion.turn);
}

NearTouch touchAt(const Vec3& lever_mm, const Vec3& normal, double gap_mm) {
  return {normal, glm::cross(lever_mm, normal), gap_mm, 0.0};
}

TEST(NearestMotion, IsTheWantedOneWhereNothingIsInTheWay) {
  std::vector<NearTouch> touches{touchAt({0, 0, 5}, {0, 0, 1}, 1.0)};
  const SmallMotion motion = nearestMotion({{0.1, 0.2, -0.5}, {0.01, 0, 0}}, kTurn_mm2, touches);
  EXPECT_EQ(motion.shift_mm, Vec3(0.1, 0.2, -0.5));
  EXPECT_NEAR(motion.turn.x, 0.01, 1e-15);
  EXPECT_EQ(touches[0].load, 0.0);
}

TEST(NearestMotion, GoesAlongAWallAsFarAsTheWallIs) {
  std::vector<NearTouch> touches{touchAt({0, 0, 0}, {0, 0, 1}, 0.1)};
  const SmallMotion motion = nearestMotion({{1.0, 0.0, -1.0}, {}}, kTurn_mm2, touches);
  EXPECT_NEAR(motion.shift_mm.x, 1.0, 1e-12);
  EXPECT_NEAR(motion.shift_mm.z, -0.1, 1e-12);
  EXPECT_NEAR(touches[0].load, 0.9, 1e-12);
}

// What makes a motion the nearest (Karush, Kuhn and Tucker): nothing is entered, touches only push,
// those that push are closed, and what they push is all that the motion lacks of the wanted one.
TEST(NearestMotion, IsTheNearestAmongManyTouchesSomeOfThemTheSame) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit;
  const auto vector = [&](double size) {
    return size * Vec3(normal(random), normal(random), normal(random));
  };
  int held = 0;
  for (int n = 0; n < 2000; ++n) {
    std::vector<NearTouch> touches;
    const int count = 1 + int(unit(random) * 30);
    for (int i = 0; i < count; ++i) {
      if (i > 0 && unit(random) < 0.3) {  // as neighbouring pieces of a plane are
        touches.push_back(touches.back());
        touches.back().gap_mm += 1e-3 * unit(random);
        continue;
      }
      touches.push_back(touchAt(vector(20.0), glm::normalize(vector(1.0)), 0.3 * unit(random)));
    }
    const SmallMotion wanted{vector(0.5), vector(0.02)};
    const SmallMotion motion = nearestMotion(wanted, kTurn_mm2, touches);
    Vec3 shift = motion.shift_mm - wanted.shift_mm, turn = motion.turn - wanted.turn;
    for (const NearTouch& touch : touches) {
      ASSERT_GE(open_mm(touch, motion), -1e-4) << n;
      ASSERT_GE(touch.load, 0.0);
      if (touch.load > 0.0) {
        ASSERT_NEAR(open_mm(touch, motion), 0.0, 1e-4) << n;
        ++held;
      }
      shift -= touch.load * touch.normal;
      turn -= touch.load / kTurn_mm2 * touch.moment;
    }
    ASSERT_LT(glm::length(shift), 1e-6) << n;
    ASSERT_LT(glm::length(turn), 1e-7) << n;
  }
  EXPECT_GT(held, 2000);
}

TEST(NearestMotion, BetweenWallsThatLeaveNoRoomItStaysFinite) {
  std::vector<NearTouch> touches{touchAt({0, 0, 0}, {0, 0, 1}, -0.1),
                                 touchAt({0, 0, 0}, {0, 0, -1}, -0.1)};
  const SmallMotion motion = nearestMotion({{0.5, 0.0, 0.0}, {}}, kTurn_mm2, touches);
  EXPECT_NEAR(motion.shift_mm.x, 0.5, 1e-12);
  EXPECT_LE(std::abs(motion.shift_mm.z), 0.1 + 1e-12);
}

}  // namespace
}  // namespace trephine
