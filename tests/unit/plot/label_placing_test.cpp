#include "plot/label_placing.h"

#include <gtest/gtest.h>

namespace trephine::plot {
namespace {

const QRectF kPage(0.0, 0.0, 200.0, 100.0);

TEST(LabelPlacing, TakesTheFirstPlaceThatIsFree) {
  const std::vector<QRectF> candidates{{-5, 0, 20, 10}, {50, 50, 20, 10}, {80, 50, 20, 10}};
  EXPECT_EQ(placed(candidates, {{55, 55, 5, 5}}, kPage), candidates[2]);
  EXPECT_EQ(placed(candidates, {}, kPage), candidates[1]);
}

TEST(LabelPlacing, TakesTheLeastCoveredWhereNoneIsFree) {
  const std::vector<QRectF> candidates{{50, 50, 20, 10}, {60, 50, 20, 10}};
  EXPECT_EQ(placed(candidates, {{50, 50, 12, 10}}, kPage), candidates[1]);
}

TEST(LabelPlacing, AroundADiscLeavesTheDiscFree) {
  const QRectF disc(90, 40, 20, 20);
  for (const QRectF& place : around(disc.center(), 10.0, {30.0, 12.0})) {
    // The corners of the disc's square are air.
    const QPointF nearest(std::clamp(100.0, place.left(), place.right()),
                          std::clamp(50.0, place.top(), place.bottom()));
    const QPointF way = nearest - disc.center();
    EXPECT_GT(QPointF::dotProduct(way, way), 81.0);
  }
}

TEST(LabelPlacing, SpreadsRowsUpFromTheLastAndKeepsTheirOrder) {
  std::vector<double> rows{10.0, 12.0, 90.0, 99.0};
  spread(rows, 20.0, 100.0);
  EXPECT_EQ(rows, (std::vector<double>{10.0, 30.0, 80.0, 100.0}));
}

}  // namespace
}  // namespace trephine::plot
