#include "plot/clip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace trephine::plot {
namespace {

const QRectF kClip(0.0, 0.0, 100.0, 50.0);

TEST(Clip, KeepsALineThatLiesWithin) {
  const std::vector<QPointF> line{{10, 10}, {50, 20}, {90, 40}};
  const auto pieces = clipped(line, kClip);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0], line);
}

TEST(Clip, CutsAtTheEdges) {
  const auto pieces = clipped({{-50, 25}, {150, 25}}, kClip);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0], (std::vector<QPointF>{{0, 25}, {100, 25}}));
}

TEST(Clip, MakesTwoPiecesOfALineThatLeavesAndComesBack) {
  EXPECT_EQ(clipped({{10, 10}, {10, 90}, {20, 90}, {20, 10}}, kClip).size(), 2u);
  EXPECT_EQ(clipped({{10, 10}, {10, 90}, {20, 10}}, kClip).size(), 2u) << "by one point outside";
}

TEST(Clip, LeavesAGapWhereAPointIsNotFinite) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(clipped({{1, 1}, {2, 2}, {nan, 3}, {4, 4}, {5, 5}}, kClip).size(), 2u);
  EXPECT_TRUE(clipped({{-1, 1}, {inf, 2}}, kClip).empty());
}

TEST(Clip, KeepsAPointThatStandsAlone) {
  const double nan = std::nan("");
  const auto pieces = clipped({{1, 1}, {nan, 1}, {3, 3}, {4, nan}, {-5, 5}, {nan, 5}}, kClip);
  EXPECT_EQ(pieces, (std::vector<std::vector<QPointF>>{{{1, 1}}, {{3, 3}}}));
  EXPECT_EQ(clipped({{5, 5}}, kClip).size(), 1u);
}

TEST(Clip, HoldsPointsThatNoPainterCould) {
  const auto pieces = clipped({{50, 1e300}, {50, -1e300}}, kClip);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_NEAR(pieces[0].front().y(), 50.0, 1e-3);
  EXPECT_NEAR(pieces[0].back().y(), 0.0, 1e-3);
}

TEST(Clip, LeavesNothingOfALineOutside) {
  EXPECT_TRUE(clipped({{-10, -10}, {200, -10}}, kClip).empty());
  EXPECT_TRUE(clipped({{-10, 40}, {30, 90}}, kClip).empty());  // past a corner
}

TEST(Thinning, KeepsTheFirstLowestHighestAndLastOfAColumnOfPixels) {
  const std::vector<QPointF> line{{1.0, 5.0}, {1.1, 6.0}, {1.2, 9.0}, {1.3, 7.0},
                                  {1.4, 2.0}, {1.5, 4.0}, {2.5, 4.0}};
  EXPECT_EQ(thinned(line),
            (std::vector<QPointF>{{1.0, 5.0}, {1.2, 9.0}, {1.4, 2.0}, {1.5, 4.0}, {2.5, 4.0}}));
  EXPECT_TRUE(thinned({}).empty());
}

TEST(Dashes, RunOnAroundCorners) {
  const std::vector<QPointF> line{{0, 0}, {5, 0}, {5, 5}, {15, 5}};
  EXPECT_EQ(dashed(line, {4, 4}),
            (std::vector<std::vector<QPointF>>{
                {{0, 0}, {4, 0}}, {{5, 3}, {5, 5}, {7, 5}}, {{11, 5}, {15, 5}}}));
  EXPECT_EQ(dashed(line, {2, 1, 5, 100}),
            (std::vector<std::vector<QPointF>>{{{0, 0}, {2, 0}}, {{3, 0}, {5, 0}, {5, 3}}}));
  EXPECT_EQ(dashed(line, {5, 3})[0], (std::vector<QPointF>{{0, 0}, {5, 0}}));
  EXPECT_EQ(dashed(line, {5, 3})[1].front(), QPointF(5, 3)) << "a gap that starts at a corner";
}

TEST(Dashes, OfALineWithoutLengthAreNone) {
  EXPECT_TRUE(dashed({}, {4, 4}).empty());
  EXPECT_TRUE(dashed({{1, 1}, {1, 1}}, {4, 4}).empty());
}

TEST(ClippedArea, IsThePartWithin) {
  const std::vector<QPointF> within{{10, 10}, {20, 10}, {20, 20}};
  EXPECT_EQ(clippedArea(within, kClip), within);
  EXPECT_TRUE(clippedArea({{-20, 0}, {-10, 0}, {-10, 90}}, kClip).empty());
  EXPECT_TRUE(clippedArea({}, kClip).empty());
  const double inf = std::numeric_limits<double>::infinity();
  QRectF around;
  for (const QPointF& p : clippedArea({{50, -1e12}, {1e300, 25}, {50, inf}, {-inf, 25}}, kClip)) {
    EXPECT_TRUE(kClip.adjusted(-1e-3, -1e-3, 1e-3, 1e-3).contains(p)) << p.x() << " " << p.y();
    around = around.united(QRectF(p, QSizeF(1e-3, 1e-3)));
  }
  EXPECT_GT(around.width(), 99.0);
  EXPECT_GT(around.height(), 49.0);
}

}  // namespace
}  // namespace trephine::plot
