#include "lab/trades/trade_charts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/display_probe.h"
#include "render/picture.h"
#include "support.h"
#include "trade_rows.h"

namespace trephine {
namespace {

using test::row;

TEST(TradeAxis, IsLinearFromZeroOverNarrowRangesAndZeroes) {
  for (const std::vector<double>& values :
       {std::vector<double>{2.0, 10.0}, std::vector<double>{0.0, 1000.0},
        std::vector<double>{0.0}}) {
    const TradeAxis axis = tradeAxis(values);
    EXPECT_FALSE(axis.logarithmic);
    EXPECT_EQ(axis.at(0.0), 0.0);
    for (double value : values) EXPECT_LE(axis.at(value), 1.0);
    EXPECT_GE(axis.ticks.size(), 2u);
  }
  EXPECT_NEAR(tradeAxis({2.0, 10.0}).at(5.6), 0.5, 1e-12);  // to 11.2
}

TEST(TradeAxis, IsLogarithmicOverWideRanges) {
  const TradeAxis axis = tradeAxis({1.0, 100.0});
  EXPECT_TRUE(axis.logarithmic);
  EXPECT_GT(axis.at(1.0), 0.0);
  EXPECT_LT(axis.at(100.0), 1.0);
  EXPECT_NEAR(axis.at(10.0), 0.5, 1e-12);
  const std::vector<double> expected{1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0};
  ASSERT_EQ(axis.ticks.size(), expected.size());
  for (std::size_t n = 0; n < expected.size(); ++n) EXPECT_NEAR(axis.ticks[n], expected[n], 1e-9);
}

TEST(TradeCharts, RefuseWhatCannotBeDrawn) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(writeTradeCharts({}, folder.path()).error().code, "BAD_ARGUMENT");
  for (double bad :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(writeTradeCharts({row("force_at", "tip", bad, 1.0)}, folder.path()).error().code,
              "BAD_ARGUMENT");
    EXPECT_EQ(writeTradeCharts({row("force_at", "tip", 1.0, bad)}, folder.path()).error().code,
              "BAD_ARGUMENT");
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// Pixels of the recommended setting's green.
std::size_t greens(const Picture& picture) {
  std::size_t count = 0;
  for (std::size_t n = 0; n + 2 < picture.rgb.size(); n += 3) {
    count += picture.rgb[n] == 20 && picture.rgb[n + 1] == 140 && picture.rgb[n + 2] == 95;
  }
  return count;
}

TEST(TradeCharts, AreOneAKnobWithTheRecommendedSettingInGreen) {
  if (!probeDisplay()) GTEST_SKIP() << "no display";
  const test::TemporaryFolder folder;
  std::vector<TradeRow> rows{row("force_at", "tip", 30.0, 400.0),
                             row("force_at", "distributed", 9.0, 900.0),
                             row("rate_hz", "250", 30.0, 0.1), row("rate_hz", "1000", 8.0, 0.3)};
  rows[1].recommended = true;
  const auto files = writeTradeCharts(rows, folder / "charts");
  ASSERT_TRUE(files) << files.error().sentence();
  ASSERT_EQ(files->size(), 2u);
  EXPECT_EQ((*files)[0].filename(), "trade-force_at.png");
  EXPECT_EQ((*files)[1].filename(), "trade-rate_hz.png");
  const auto with = readPng((*files)[0]), without = readPng((*files)[1]);
  ASSERT_TRUE(with && without);
  EXPECT_EQ(with->width, 1200);
  EXPECT_EQ(with->height, 800);
  EXPECT_GT(greens(*with), 200u);  // a disc of 10 pixels has 314
  EXPECT_EQ(greens(*without), 0u);
}

}  // namespace
}  // namespace trephine
