#include "lab/trades/trade_charts.h"

#include <gtest/gtest.h>

#include <QImage>
#include <algorithm>
#include <limits>

#include "plot/drawing.h"
#include "support.h"
#include "unit/machine/trade_rows.h"
#include "unit/plot/plots.h"

namespace trephine {
namespace {

using test::row;

TEST(TradeAxis, IsLinearFromZeroOverNarrowRangesAndZeroes) {
  for (const std::vector<double>& figures :
       {std::vector<double>{2.0, 10.0}, std::vector<double>{0.0, 1000.0}, std::vector<double>{0.0},
        std::vector<double>{}}) {
    const plot::Axis axis = tradeAxis("Cost", "ns", figures);
    EXPECT_FALSE(axis.logarithmic);
    EXPECT_EQ(axis.share(0.0), 0.0);
    for (double figure : figures) EXPECT_TRUE(axis.holds(figure));
  }
  EXPECT_NEAR(tradeAxis("Cost", "ns", {2.0, 10.0}).share(5.6), 0.5, 1e-12);  // to 11.2
}

TEST(TradeAxis, IsLogarithmicOverWideRanges) {
  const plot::Axis axis = tradeAxis("Cost", "ns", {1.0, 100.0});
  EXPECT_TRUE(axis.logarithmic);
  EXPECT_TRUE(axis.holds(1.0) && axis.holds(100.0));
  EXPECT_NEAR(axis.share(10.0), 0.5, 1e-12);
}

TEST(TradeCharts, RefuseWhatCannotBeDrawn) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(writeTradeCharts({}, folder.path()).error().code.str(), "BAD_ARGUMENT");
  for (double bad :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(
        writeTradeCharts({row("force_at", "tip", bad, 1.0)}, folder.path()).error().code.str(),
        "BAD_ARGUMENT");
    EXPECT_EQ(
        writeTradeCharts({row("force_at", "tip", 1.0, bad)}, folder.path()).error().code.str(),
        "BAD_ARGUMENT");
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// Pixels of the recommended setting's green.
int greens(const QImage& picture) {
  const QRgb green = plot::colourOf(plot::Tone::good, plot::Theme::light).rgb();
  int count = 0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) count += picture.pixel(x, y) == green;
  }
  return count;
}

TEST(TradeCharts, AreOneAKnobWithTheRecommendedSettingInGreen) {
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
  const QImage with((*files)[0].c_str()), without((*files)[1].c_str());
  EXPECT_EQ(with.size(), QSize(1200, 800));
  EXPECT_GT(greens(with), 200);  // a disc of 10 pixels has 314
  EXPECT_EQ(greens(without), 0);
}

TEST(TradeCharts, SayErrorAndCostWithTheirUnitsAndWhatIsGoodEnough) {
  const Result<plot::Drawing> drawing =
      plot::draw(tradeChart({row("rate_hz", "250", 30.0, 0.1), row("rate_hz", "1000", 8.0, 0.3),
                             row("rate_hz", "20000", 0.1, 40.0)}));
  ASSERT_TRUE(drawing);
  plot::test::expectTextsApart(*drawing);
  for (const std::string words :
       {"Rate of touch: error over cost", "Error against: truth", "Cost [ns]", "Error [%]",
        "250 Hz", "1000 Hz", "20000 Hz", "tolerance 5 %", "at most 25 ns",
        "Good enough: error at most 5 %; cost at most 25 ns; bone of k max at most 60 %"}) {
    EXPECT_TRUE(std::any_of(drawing->texts.begin(), drawing->texts.end(),
                            [&](const plot::PlacedText& t) { return t.text == words; }))
        << words;
  }
}

TEST(TradeCharts, JoinSettingsThatAreNumbersAndNotWords) {
  EXPECT_EQ(tradeChart({row("rate_hz", "250", 3, 1), row("rate_hz", "500", 2, 2)}).lines.size(),
            1u);
  EXPECT_TRUE(
      tradeChart({row("force_at", "tip", 3, 1), row("force_at", "all", 2, 2)}).lines.empty());
}

}  // namespace
}  // namespace trephine
