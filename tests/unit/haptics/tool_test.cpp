#include "haptics/tool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace trephine {
namespace {

TEST(Tool, PointKOfABladeLiesKOverITimesItsLengthAlongIt) {
  const Tool blade = makeBlade(0.020, 5);
  for (int k = 0; k < 5; ++k) {
    EXPECT_DOUBLE_EQ(blade.points_m[std::size_t(k)].z, 0.020 * k / 4.0);
    EXPECT_EQ(blade.points_m[std::size_t(k)].x, 0.0);
  }
}

TEST(Tool, TheWeightsOfItsPointsSumToOne) {
  for (const Tool& tool : {makeNeedle(0.05), makeNeedle(0.05, 9), makeBlade(0.02, 2),
                           makeBlade(0.02, 64), makeBurr(0.003, 64, 0, 0.03),
                           makeBurr(0.003, 64, 8, 0.03), makeBurr(0.003, 5, 1, 0.03)}) {
    ASSERT_EQ(tool.points_m.size(), tool.weights.size());
    EXPECT_NEAR(std::accumulate(tool.weights.begin(), tool.weights.end(), 0.0), 1.0, 1e-12);
  }
}

TEST(Tool, ABurrsShellCoversItsBallEvenly) {
  const Tool burr = makeBurr(0.003, 64, 8, 0.030);
  ASSERT_EQ(burr.points_m.size(), 72u);
  Vec3 sum(0.0);
  for (std::size_t i = 0; i < 64; ++i) {
    const Vec3 from_centre = burr.points_m[i] - Vec3(0, 0, 0.003);
    EXPECT_NEAR(glm::length(from_centre), 0.003, 1e-12);
    sum += from_centre;
  }
  EXPECT_LT(glm::length(sum) / 64, 0.03 * 0.003);
  for (std::size_t i = 64; i < 72; ++i) {
    EXPECT_EQ(burr.points_m[i].x, 0.0);
    EXPECT_GT(burr.points_m[i].z, 0.006);
    EXPECT_LE(burr.points_m[i].z, 0.030 + 1e-12);
  }
}

TEST(Tool, ACylindersShellLiesOnARodWithRoundEnds) {
  ToolDescription d{ToolKind::burr, 30.0, 100, 2.0, 0, BurrShape::cylinder, 10.0, 0.0};
  const Result<Tool> burr = makeTool(d);
  ASSERT_TRUE(burr.ok());
  for (const Vec3& p : burr->points_m) {
    const Vec3 foot(0, 0, std::clamp(p.z, 0.002, 0.008));
    EXPECT_NEAR(glm::length(p - foot), 0.002, 1e-12);
  }
  EXPECT_DOUBLE_EQ(burr->solid_to_m.z, 0.008);
}

TEST(Tool, ItsTipIsTheOriginAndItsSolidReachesIt) {
  EXPECT_EQ(makeNeedle(0.05, 3).points_m[0], Vec3(0.0));
  EXPECT_EQ(makeBlade(0.02, 9).points_m[0], Vec3(0.0));
  const Tool burr = makeBurr(0.003, 64, 8, 0.03);
  EXPECT_DOUBLE_EQ(burr.solid_from_m.z - burr.radius_m, 0.0);
}

TEST(Tool, RefusesWhatCannotBe) {
  const auto refused = [](auto change) {
    ToolDescription d{ToolKind::burr, 30.0, 64, 3.0, 8, BurrShape::sphere, 0.0, 4.0};
    EXPECT_TRUE(makeTool(d).ok());
    change(d);
    const Result<Tool> tool = makeTool(d);
    EXPECT_FALSE(tool.ok());
    return tool.ok() ? std::string() : tool.error().where;
  };
  EXPECT_EQ(refused([](auto& d) { d.length_mm = 1100; }), "length_mm");
  EXPECT_EQ(refused([](auto& d) { d.length_mm = std::nan(""); }), "length_mm");
  EXPECT_EQ(refused([](auto& d) { d.length_mm = 5; }), "length_mm");
  EXPECT_EQ(refused([](auto& d) { d.points = 0; }), "points");
  EXPECT_EQ(refused([](auto& d) { d.points = 10001; }), "points");
  EXPECT_EQ(refused([](auto& d) { d.radius_mm = 0; }), "radius_mm");
  EXPECT_EQ(refused([](auto& d) { d.radius_mm = std::nan(""); }), "radius_mm");
  EXPECT_EQ(refused([](auto& d) { d.shaft_points = -1; }), "shaft_points");
  EXPECT_EQ(refused([](auto& d) { d.motor_W = -1; }), "motor_W");
  EXPECT_EQ(refused([](auto& d) { d.shape = BurrShape::cylinder; }), "head_mm");
  EXPECT_TRUE(makeTool({ToolKind::blade, 0.0, 1}).ok());
  EXPECT_TRUE(makeTool({ToolKind::blade, 1000.0, 10000}).ok());
}

}  // namespace
}  // namespace trephine
