#include "plot/axis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace trephine::plot {
namespace {

std::vector<std::string> textsOf(const Ticks& ticks) {
  std::vector<std::string> texts;
  for (const Tick& tick : ticks.ticks) texts.push_back(tick.text);
  return texts;
}

using Texts = std::vector<std::string>;

Axis linear(const std::string& unit, double low, double high) {
  return {"Force", unit, false, low, high};
}

Axis decades(double low, double high, std::vector<double> at = {}) {
  return {"Period", "ms", true, low, high, std::move(at)};
}

TEST(Number, IsTheSameInEveryLocaleAndShort) {
  EXPECT_EQ(number(1e6), "1e6");
  EXPECT_EQ(number(1.5e-7), "1.5e-7");
  EXPECT_EQ(number(0.25), "0.25");
  EXPECT_EQ(number(123456.0), "1.235e5");
  EXPECT_EQ(number(123456.0, 6), "123456");
}

TEST(RoundStep, IsOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(roundStep(0.9), 1.0);
  EXPECT_DOUBLE_EQ(roundStep(1.0), 1.0);
  EXPECT_DOUBLE_EQ(roundStep(1.1), 2.0);
  EXPECT_DOUBLE_EQ(roundStep(3e-6), 5e-6);
  EXPECT_DOUBLE_EQ(roundStep(6e6), 1e7);
}

TEST(Prefixes, OfTheSiGrowAndShrinkAUnit) {
  EXPECT_EQ(prefixed("N", -3), "mN");
  EXPECT_EQ(prefixed("N/m", 3), "kN/m");
  EXPECT_EQ(prefixed("N s/m", 3), "kN s/m");
  EXPECT_EQ(prefixed("s", -6), "\u00b5s");
  EXPECT_EQ(prefixed("ms", -3), "\u00b5s");
  EXPECT_EQ(prefixed("ns", 3), "\u00b5s");
  EXPECT_EQ(prefixed("Hz", 3), "kHz");
}

TEST(Prefixes, AreNotPutBeforeUnitsThatTakeNone) {
  for (const char* unit : {"", "%", "kg", "mm^3", "voxels", "1/s", "HU"}) {
    EXPECT_EQ(prefixed(unit, 3), "") << unit;
  }
}

TEST(LinearTicks, AreRoundAndNameTheUnit) {
  const Ticks ticks = ticksOf(linear("N", 0.0, 3.1), 0.1);
  EXPECT_EQ(ticks.title, "Force [N]");
  EXPECT_EQ(textsOf(ticks), (Texts{"0", "0.5", "1", "1.5", "2", "2.5", "3"}));
  EXPECT_NEAR(ticks.ticks[2].share, 1.0 / 3.1, 1e-12);
}

TEST(LinearTicks, OfAMillionthAndOfAMillionStayShortByAPrefix) {
  const Ticks small = ticksOf(linear("N", 0.0, 1e-6), 0.15);
  EXPECT_EQ(small.title, "Force [\u00b5N]");
  EXPECT_EQ(textsOf(small), (Texts{"0", "0.2", "0.4", "0.6", "0.8", "1"}));
  const Ticks large = ticksOf(linear("N", -1e6, 1e6), 0.2);
  EXPECT_EQ(large.title, "Force [MN]");
  EXPECT_EQ(textsOf(large), (Texts{"-1", "-0.5", "0", "0.5", "1"}));
}

TEST(LinearTicks, OfAUnitThatTakesNoPrefixNameThePowerOfTen) {
  const Ticks small = ticksOf(linear("%", 0.0, 4e-6), 0.2);
  EXPECT_EQ(small.title, "Force [10\u207b\u2076 %]");
  EXPECT_EQ(textsOf(small), (Texts{"0", "1", "2", "3", "4"}));
  EXPECT_EQ(ticksOf(linear("voxels", 0.0, 2e6), 0.2).title, "Force [10\u2076 voxels]");
  EXPECT_EQ(ticksOf(linear("", 0.0, 2e6), 0.2).title, "Force [10\u2076]");
}

TEST(LinearTicks, KeepAUnitWhoseNumbersAreShortAnyway) {
  EXPECT_EQ(ticksOf(linear("%", 0.0, 0.05), 0.2).title, "Force [%]");
  EXPECT_EQ(ticksOf(linear("N", 0.0, 9000.0), 0.2).title, "Force [N]");
  EXPECT_EQ(ticksOf(linear("", 0.0, 1.0), 0.2).title, "Force");
}

TEST(LinearTicks, FarFromZeroHaveAllTheDigitsThatTellThemApart) {
  const Ticks ticks = ticksOf(linear("HU", 100000.0, 100000.2), 0.3);
  EXPECT_EQ(textsOf(ticks), (Texts{"100000", "100000.1", "100000.2"}));
}

TEST(LinearTicks, OfEndsThatADoubleCannotPartComeToAnEnd) {
  EXPECT_LE(ticksOf(linear("N", 1.0, std::nextafter(1.0, 2.0)), 0.1).ticks.size(), 12u);
  EXPECT_LE(ticksOf(linear("N", 1e17, 1e17 + 64.0), 0.1).ticks.size(), 12u);
}

TEST(LogarithmicTicks, AreOneTwoAndFiveOrDecadesByTheirRoom) {
  EXPECT_EQ(textsOf(ticksOf(decades(-0.1, 2.1), 0.05)),
            (Texts{"1", "2", "5", "10", "20", "50", "100"}));
  EXPECT_EQ(textsOf(ticksOf(decades(-0.1, 2.1), 0.2)), (Texts{"1", "10", "100"}));
  EXPECT_EQ(textsOf(ticksOf(decades(-6.1, 6.1), 0.2)),
            (Texts{"1e-6", "0.001", "1", "1000", "1e6"}));
}

TEST(LogarithmicTicks, AreTwoAtLeastWhereOneDecadeAloneWouldBeNoScale) {
  EXPECT_EQ(textsOf(ticksOf(decades(-2.96, -1.45), 0.2)), (Texts{"0.003", "0.01", "0.03"}));
  EXPECT_EQ(textsOf(ticksOf(decades(0.1, 1.75), 0.2)), (Texts{"3", "10", "30"}));
}

TEST(LogarithmicTicks, OverLessThanADecadeAreRoundValues) {
  const Ticks ticks = ticksOf(decades(std::log10(1.0), std::log10(1.001)), 0.3);
  EXPECT_EQ(textsOf(ticks), (Texts{"1", "1.0005", "1.001"}));
  EXPECT_EQ(ticks.title, "Period [ms]");
}

TEST(LogarithmicTicks, ReachBeyondWhatADoubleHolds) {
  const Ticks ticks = ticksOf(decades(-343.0, 346.0), 0.1);
  ASSERT_GE(ticks.ticks.size(), 4u);
  for (const Tick& tick : ticks.ticks) EXPECT_TRUE(tick.share > 0.0 && tick.share < 1.0);
}

TEST(Ticks, StandAtTheAxisOwnValuesWhereTheseHaveRoom) {
  EXPECT_EQ(textsOf(ticksOf(decades(-1.0, 1.0, {0.25, 1.0, 3.0}), 0.1)), (Texts{"0.25", "1", "3"}));
  EXPECT_EQ(textsOf(ticksOf(decades(-1.0, 1.0, {0.25, 1.0, 1.1}), 0.1)),
            (Texts{"0.1", "0.2", "0.5", "1", "2", "5", "10"}));
  EXPECT_EQ(textsOf(ticksOf(decades(-0.2, 0.2, {1.0}), 0.3)), (Texts{"1", "1.5"}))
      << "one alone gives no scale";
}

TEST(Ticks, AreNeverCloserThanTheirRoomOverAnyRange) {
  for (int e = -6; e <= 6; ++e) {
    for (const double from : {0.0, 0.3, -2.0}) {
      for (const double room : {0.05, 0.17, 0.5}) {
        const double scale = std::pow(10.0, e);
        const Ticks ticks = ticksOf(linear("N", from * scale, 1.7 * scale), room);
        EXPECT_GE(ticks.ticks.size(), room < 0.2 ? 3u : 1u) << e << " " << from << " " << room;
        for (std::size_t i = 0; i < ticks.ticks.size(); ++i) {
          const double share = ticks.ticks[i].share;
          EXPECT_TRUE(share > -1e-9 && share < 1.0 + 1e-9);
          EXPECT_LE(ticks.ticks[i].text.size(), 6u) << ticks.ticks[i].text;
          if (i > 0) {
            EXPECT_GT(share - ticks.ticks[i - 1].share, room * (1.0 - 1e-6));
          }
        }
      }
    }
  }
}

TEST(Axis, HoldsNoZeroWhereItIsLogarithmic) {
  EXPECT_FALSE(decades(-300.0, 2.0).holds(0.0));
  EXPECT_FALSE(decades(-300.0, 2.0).holds(std::nan("")));
  EXPECT_TRUE(decades(-1.0, 1.0).holds(10.0));
  EXPECT_DOUBLE_EQ(decades(-1.0, 1.0).share(1.0), 0.5);
  for (const double value : {0.0, -5.0}) {
    EXPECT_EQ(decades(-1.0, 1.0).share(value), -std::numeric_limits<double>::infinity());
  }
}

}  // namespace
}  // namespace trephine::plot
