#include "plot/drawing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "plots.h"

namespace trephine::plot {
namespace {

using test::expectTextsApart;

Plot empty() {
  Plot plot;
  plot.width_px = 600;
  plot.height_px = 400;
  plot.title = "A title";
  plot.x = {"Time", "s", false, 0.0, 10.0};
  plot.y = {"Force", "N", false, 0.0, 4.0};
  return plot;
}

Drawing drawn(const Plot& plot, Theme theme = Theme::light) {
  Result<Drawing> drawing = draw(plot, theme);
  EXPECT_TRUE(drawing) << (drawing ? "" : drawing.error().sentence());
  return drawing ? *drawing : Drawing();
}

QPointF at(const Drawing& drawing, const Plot& plot, double x, double y) {
  return {drawing.area.left() + plot.x.share(x) * drawing.area.width(),
          drawing.area.bottom() - plot.y.share(y) * drawing.area.height()};
}

// How far two colours are apart, 0 to 255.
int apart(QRgb a, QRgb b) {
  return std::max({std::abs(qRed(a) - qRed(b)), std::abs(qGreen(a) - qGreen(b)),
                   std::abs(qBlue(a) - qBlue(b))});
}

QRgb pixel(const Drawing& drawing, const QPointF& point) {
  return drawing.image.pixel(int(point.x()), int(point.y()));
}

bool says(const Drawing& drawing, const std::string& text) {
  return std::any_of(drawing.texts.begin(), drawing.texts.end(),
                     [&](const PlacedText& t) { return t.text == text; });
}

TEST(Drawing, SaysTitleAxesWithUnitsAndTicks) {
  const Drawing drawing = drawn(empty());
  EXPECT_EQ(drawing.image.size(), QSize(600, 400));
  for (const char* text : {"A title", "Time [s]", "Force [N]", "0", "10", "4"}) {
    EXPECT_TRUE(says(drawing, text)) << text;
  }
  expectTextsApart(drawing);
}

TEST(Drawing, OfALineLiesWhereItsValuesAre) {
  Plot plot = empty();
  plot.lines = {{{{0.0, 1.0}, {5.0, 3.0}, {10.0, 3.0}}, Tone::series_1, 3.0}};
  const Drawing drawing = drawn(plot);
  const QRgb blue = colourOf(Tone::series_1, Theme::light).rgb();
  for (const auto& [x, y] : {std::pair{1.0, 1.4}, {2.5, 2.0}, {4.0, 2.6}, {7.0, 3.0}, {9.9, 3.0}}) {
    const QPointF on = at(drawing, plot, x, y);
    EXPECT_LT(apart(pixel(drawing, on), blue), 60) << x;
    for (const double off : {-8.0, 8.0}) {
      EXPECT_GT(apart(pixel(drawing, on + QPointF(0.0, off)), blue), 100) << x << " " << off;
    }
  }
}

TEST(Drawing, OfALineOnLogarithmicAxesIsStraightInDecades) {
  Plot plot = empty();
  plot.x = {"T", "ms", true, -1.0, 1.0};
  plot.y = {"k", "N/m", true, 0.0, 4.0};
  plot.lines = {{{{0.1, 10.0}, {10.0, 1000.0}}, Tone::series_1, 3.0}};
  const Drawing drawing = drawn(plot);
  const QPointF middle = drawing.area.center();
  EXPECT_LT(apart(pixel(drawing, middle), colourOf(Tone::series_1, Theme::light).rgb()), 60);
}

TEST(Drawing, KeepsLinesWithinTheAxesAndLeavesGaps) {
  Plot plot = empty();
  const double nan = std::nan("");
  plot.lines = {{{{-100.0, -100.0}, {100.0, 100.0}, {nan, 1.0}, {2.0, 1e300}, {3.0, -1e300}},
                 Tone::series_2,
                 5.0}};
  const Drawing drawing = drawn(plot);
  const QRgb ink = colourOf(Tone::series_2, Theme::light).rgb();
  for (int y = 0; y < 400; ++y) {
    for (int x = 0; x < 600; ++x) {
      if (drawing.area.adjusted(-4, -4, 4, 4).contains(x, y)) continue;
      ASSERT_GT(apart(drawing.image.pixel(x, y), ink), 40) << x << " " << y;
    }
  }
}

TEST(Drawing, OfAHundredThousandPointsReachesAllOfThemAndTakesNoMinute) {
  Plot plot = empty();
  plot.width_px = 1200;
  plot.height_px = 800;
  plot.lines = {{{}, Tone::series_1, 1.5}};
  for (int i = 0; i <= 100000; ++i) {
    plot.lines[0].points.push_back({1e-4 * i, i == 70001 ? 3.9 : 0.5 + 0.024 * ((37 * i) % 101)});
  }
  plot.marks = {{{4.0, 2.0}, "a mark"}, {{6.0, 2.0}, "another"}};  // in the thick of it
  const auto start = std::chrono::steady_clock::now();
  const Drawing drawing = drawn(plot);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(3));
  const QRgb blue = colourOf(Tone::series_1, Theme::light).rgb();
  EXPECT_LT(apart(pixel(drawing, at(drawing, plot, 7.0001, 3.4)), blue), 120) << "one value alone";
}

TEST(Drawing, OfADashedLineOfThousandsOfTurnsTakesNoMinute) {
  Plot plot = empty();
  plot.width_px = 1200;
  plot.height_px = 800;
  plot.lines = {{{}, Tone::series_1, 1.5, {6.0, 4.0}}};
  for (int i = 0; i < 10000; ++i) plot.lines[0].points.push_back({1e-3 * i, i % 2 ? 3.5 : 0.5});
  const auto start = std::chrono::steady_clock::now();
  drawn(plot);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(3));
}

TEST(Drawing, OfADashedLineHasGaps) {
  Plot plot = empty();
  plot.lines = {{{{0.0, 2.25}, {10.0, 2.25}}, Tone::series_1, 3.0, {6.0, 10.0}}};
  const Drawing drawing = drawn(plot);
  const QRgb blue = colourOf(Tone::series_1, Theme::light).rgb();
  const QPointF start = at(drawing, plot, 0.0, 2.25);
  EXPECT_LT(apart(pixel(drawing, start + QPointF(3.0, 0.0)), blue), 60);
  EXPECT_GT(apart(pixel(drawing, start + QPointF(11.0, 0.0)), blue), 100);
  EXPECT_LT(apart(pixel(drawing, start + QPointF(19.0, 0.0)), blue), 60);
}

TEST(Drawing, OfAPointThatStandsAloneIsADot) {
  Plot plot = empty();
  const double nan = std::nan("");
  plot.lines = {{{{5.3, 2.2}}, Tone::series_1, 1.5, {}, "", "alone"},
                {{{1.0, nan}, {2.3, 2.2}, {nan, 2.0}}, Tone::series_2, 1.5, {4, 4}, "", "gaps"}};
  const Drawing drawing = drawn(plot);
  for (const auto& [x, tone] : {std::pair{5.3, Tone::series_1}, {2.3, Tone::series_2}}) {
    EXPECT_LT(apart(pixel(drawing, at(drawing, plot, x, 2.2)), colourOf(tone, Theme::light).rgb()),
              80);
  }
  EXPECT_TRUE(says(drawing, "alone") && says(drawing, "gaps"));
}

Plot banded(std::vector<Band::Span> spans) {
  Plot plot = empty();
  plot.bands = {{std::move(spans), Tone::good, "allowed"}};
  return plot;
}

bool filled(const Drawing& drawing, const Plot& plot, double x, double y) {
  return apart(pixel(drawing, at(drawing, plot, x, y)), qRgb(255, 255, 255)) > 20;
}

TEST(Drawing, OfABandLeavesAGapWhereAValueIsNotFinite) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const Plot plot = banded({{0, 1, 3}, {2, 1, 3}, {4, nan, 3}, {5, 1, 3}, {7, 1, inf}, {9, 1, 3}});
  const Drawing drawing = drawn(plot);
  for (const double x : {0.7, 1.7, 5.0, 9.0}) EXPECT_TRUE(filled(drawing, plot, x, 1.9)) << x;
  for (const double x : {2.7, 3.7, 4.7, 6.3, 7.7}) {
    EXPECT_FALSE(filled(drawing, plot, x, 1.9)) << x;
  }
}

TEST(Drawing, OfABandKeepsItsSlopeBeyondTheAxes) {
  const Plot plot = banded({{0, 0, 4}, {10, 0, -36}});  // meets the axis at 1
  const Drawing drawing = drawn(plot);
  EXPECT_TRUE(filled(drawing, plot, 0.4, 1.3));
  EXPECT_FALSE(filled(drawing, plot, 0.8, 1.3));
  EXPECT_FALSE(filled(drawing, plot, 5.3, 0.7));
}

TEST(Drawing, OfABandFromZeroReachesTheLowEndOfALogarithmicAxis) {
  Plot plot = banded({{0, 0, 10}, {10, -1, 10}});
  plot.y = {"k", "N/m", true, -1.0, 2.0};
  const Drawing drawing = drawn(plot);
  EXPECT_TRUE(filled(drawing, plot, 5.3, 0.15));
  EXPECT_FALSE(filled(drawing, plot, 5.3, 15.0));
}

TEST(Drawing, OfABandFillsBetweenItsLines) {
  const Plot plot = banded({{0.0, 1.0, 3.0}, {10.0, 1.0, 3.0}});
  const Drawing drawing = drawn(plot);
  const QRgb inside = pixel(drawing, at(drawing, plot, 5.3, 1.9));
  const QRgb below = pixel(drawing, at(drawing, plot, 5.3, 0.7));
  EXPECT_EQ(below, qRgb(255, 255, 255));
  EXPECT_GT(apart(inside, below), 20);
  EXPECT_TRUE(says(drawing, "allowed"));
}

Plot heat() {
  Plot plot = empty();
  plot.height_px = 600;
  plot.heat_map.emplace();
  plot.heat_map->columns = {2.0, 5.0, 8.0};
  plot.heat_map->rows = {1.0, 3.0};
  plot.heat_map->levels = {{Shape::pill, Tone::heat_1, "none"},
                           {Shape::rectangle, Tone::heat_3, "some"},
                           {Shape::hexagon, Tone::heat_5, "all"}};
  plot.heat_map->heading = {"Counts", "Shares"};
  plot.heat_map->cells = {
      {{2.0, 1.0}, 0, {"0/9", ""}}, {{5.0, 1.0}, 1, {"4/9", "44%"}}, {{8.0, 3.0}, 2, {"9/9", ""}}};
  return plot;
}

// Beside a text, in the same cell or beside it in the legend.
QRgb leftOf(const Drawing& drawing, const std::string& text, double by) {
  for (const PlacedText& placed : drawing.texts) {
    if (placed.text == text)
      return pixel(drawing, {placed.rect.left() - by, placed.rect.center().y()});
  }
  ADD_FAILURE() << "no text " << text;
  return 0;
}

TEST(Drawing, OfAHeatMapHasTheColoursThatItsLegendSays) {
  for (const Theme theme : {Theme::light, Theme::dark}) {
    const Drawing drawing = drawn(heat(), theme);
    for (const auto& [cell, legend, tone] : {std::tuple{"0/9", "none", Tone::heat_1},
                                             {"4/9", "some", Tone::heat_3},
                                             {"9/9", "all", Tone::heat_5}}) {
      EXPECT_EQ(leftOf(drawing, cell, 4.0), colourOf(tone, theme).rgb()) << cell;
      EXPECT_EQ(leftOf(drawing, legend, 28.0), colourOf(tone, theme).rgb()) << legend;
    }
    expectTextsApart(drawing);
  }
}

TEST(Drawing, OfAHeatMapLiesWhereItsValuesAre) {
  const Plot plot = heat();
  const Drawing drawing = drawn(plot);
  for (const HeatMap::Cell& cell : plot.heat_map->cells) {
    const auto text = std::find_if(drawing.texts.begin(), drawing.texts.end(),
                                   [&](const PlacedText& t) { return t.text == cell.text.full; });
    ASSERT_NE(text, drawing.texts.end());
    const QPointF off = text->rect.center() - at(drawing, plot, cell.at.x, cell.at.y);
    EXPECT_LT(std::hypot(off.x(), off.y()), 1.0);
  }
}

TEST(Drawing, OfADashedLineOverACellLeavesTheCellWholeBetweenItsDashes) {
  Plot plot = heat();
  plot.lines = {{{{0.0, 1.15}, {10.0, 1.15}}, Tone::series_1, 2.5, {6.0, 10.0}}};
  const Drawing drawing = drawn(plot);
  const QRgb fill = colourOf(Tone::heat_3, Theme::light).rgb();
  const QPointF start = at(drawing, plot, 0.0, 1.15), cell = at(drawing, plot, 5.0, 1.15);
  int gaps = 0;
  for (double x = start.x() + 11.0; x < drawing.area.right(); x += 16.0) {
    if (std::abs(x - cell.x()) > 36.0) continue;
    ++gaps;
    EXPECT_EQ(pixel(drawing, {x, start.y()}), fill) << x - cell.x();
  }
  EXPECT_GE(gaps, 3);
}

TEST(Drawing, OfAHeatMapWithNarrowCellsBearsTheBriefTextsAndSaysSo) {
  Plot plot = heat();
  plot.heat_map->columns.clear();
  plot.heat_map->cells.clear();
  for (int i = 1; i <= 10; ++i) {
    plot.heat_map->columns.push_back(0.95 * i);
    plot.heat_map->cells.push_back({{0.95 * i, 1.0}, 1, {"123/4567", "9%"}});
  }
  const Drawing brief = drawn(plot);
  EXPECT_TRUE(says(brief, "Shares") && says(brief, "9%") && !says(brief, "123/4567"));
  expectTextsApart(brief);
  for (auto& cell : plot.heat_map->cells) cell.text.brief = "much longer than a cell";
  const Drawing none = drawn(plot);
  EXPECT_FALSE(says(none, "Shares") || says(none, "Counts"));
}

TEST(Drawing, OfMarksThatLieTogetherKeepsTheirTextsApart) {
  Plot plot = empty();
  for (int i = 0; i < 8; ++i) {
    plot.marks.push_back({{9.0 + 0.01 * i, 1.0 + 0.02 * i}, "setting " + std::to_string(i)});
  }
  plot.marks[3].strong = true;
  plot.guides = {{true, 1.05, "tolerance 1.05 N"}, {false, 9.0, "at most 9 s"}};
  const Drawing drawing = drawn(plot);
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(says(drawing, "setting " + std::to_string(i)));
  EXPECT_TRUE(says(drawing, "tolerance 1.05 N") && says(drawing, "at most 9 s"));
  expectTextsApart(drawing);
}

TEST(Drawing, LeavesOutGuidesAndMarksThatLieBeyondTheAxes) {
  Plot plot = empty();
  plot.marks = {{{20.0, 1.0}, "a mark"}};
  plot.guides = {{true, 5.0, "a guide"}};
  const Drawing drawing = drawn(plot);
  EXPECT_FALSE(says(drawing, "a mark") || says(drawing, "a guide"));
}

TEST(Drawing, NamesLinesBesideTheirEndsOneOverTheOther) {
  Plot plot = empty();
  for (int i = 0; i < 4; ++i) {
    plot.lines.push_back({{{0.0, 1.0 + 0.01 * i}, {10.0, 1.0 + 0.01 * i}},
                          Tone(int(Tone::series_1) + i),
                          2.0,
                          {},
                          "line " + std::to_string(i),
                          "legend " + std::to_string(i)});
  }
  const Drawing drawing = drawn(plot);
  double above = 1e9;
  for (int i = 0; i < 4; ++i) {
    const auto name = std::find_if(drawing.texts.begin(), drawing.texts.end(), [&](const auto& t) {
      return t.text == "line " + std::to_string(i);
    });
    ASSERT_NE(name, drawing.texts.end());
    EXPECT_GT(name->rect.left(), drawing.area.right());
    EXPECT_LT(name->rect.top(), above) << "the higher line's name stands higher";
    above = name->rect.top();
    EXPECT_TRUE(says(drawing, "legend " + std::to_string(i)));
  }
  expectTextsApart(drawing);
}

TEST(Drawing, SaysOfALineOutsideOfTheAxesThatItIsThere) {
  Plot plot = empty();
  plot.lines = {{{{0.0, 50.0}, {10.0, 50.0}}, Tone::series_1, 2.0, {}, "far", "far away"}};
  plot.lines.push_back({{{std::nan(""), 1.0}}, Tone::series_2, 2.0, {}, "", "nothing"});
  plot.bands = {{{{0.0, 50.0, 60.0}}, Tone::good, "far band"}, {{}, Tone::good, "no band"}};
  const Drawing drawing = drawn(plot);
  EXPECT_TRUE(says(drawing, "far away: outside of these axes"));
  EXPECT_TRUE(says(drawing, "far band: outside of these axes"));
  EXPECT_TRUE(says(drawing, "nothing: no values") && says(drawing, "no band: no values"));
  EXPECT_FALSE(says(drawing, "far"));
}

TEST(Drawing, OfTextsOfAnyLengthKeepsThemWithinThePicture) {
  const std::string text(400, 'W');
  Plot plot = heat();
  plot.title = plot.x.title = plot.y.title = plot.legend_heading = text;
  plot.notes = {text, text, text};
  plot.heat_map->heading.full = text;
  for (auto& level : plot.heat_map->levels) level.legend = text;
  plot.lines = {{{{0.0, 1.0}, {10.0, 1.0}}, Tone::series_1, 2.0, {}, text, text}};
  plot.guides = {{true, 2.0, text}};
  plot.marks = {{{9.0, 3.0}, text}};
  const Drawing drawing = drawn(plot);
  for (const PlacedText& placed : drawing.texts) {
    EXPECT_TRUE(QRectF(drawing.image.rect()).contains(placed.rect)) << placed.text;
  }
}

TEST(Drawing, OfAnySizeKeepsItsTextsWithinAndWholeOrRefuses) {
  Plot plot = empty();
  plot.notes = {"a note", "a note that is longer"};
  plot.y = {"Force", "HU", false, 1234.5, 1237.5};
  for (int i = 0; i < 5; ++i) {
    const std::string text = "line " + std::to_string(i);
    plot.lines.push_back(
        {{{0.0, 1235.0}, {10.0, 1236.0}}, Tone::series_1, 2.0, {}, text, "of arm " + text});
  }
  int drawn = 0, refused = 0;
  for (plot.width_px = 200; plot.width_px < 2000; plot.width_px = plot.width_px * 5 / 4) {
    for (plot.height_px = 200; plot.height_px < 2000; plot.height_px = plot.height_px * 5 / 4) {
      const Result<Drawing> drawing = draw(plot);
      if (drawing) {
        ++drawn;
        expectTextsApart(*drawing);
        for (const char* text : {"1235", "1236", "of arm line 4"}) {
          EXPECT_TRUE(says(*drawing, text)) << plot.width_px << " x " << plot.height_px << text;
        }
      } else {
        ++refused;
        EXPECT_EQ(drawing.error().code.str(), "BAD_ARGUMENT");
        EXPECT_NE(drawing.error().what.find("no room"), std::string::npos);
      }
    }
  }
  EXPECT_GT(drawn, 20);
  EXPECT_GT(refused, 10);
}

TEST(Drawing, GivesTheAxesTheRowOfALegendThatHasNoHeading) {
  Plot plot = empty();
  plot.lines = {{{{0.0, 1.0}, {10.0, 1.0}}, Tone::series_1, 2.0, {}, "", "a line"}};
  const double without = drawn(plot).area.height();
  plot.legend_heading = "A heading";
  EXPECT_EQ(drawn(plot).area.height(), without - 25.0);
}

TEST(Drawing, WritesItsNotesInOneSize) {
  Plot plot = empty();
  plot.notes = {std::string(90, 'w'), "short"};
  const Drawing drawing = drawn(plot);
  ASSERT_TRUE(says(drawing, "short"));
  std::vector<double> heights;
  for (const PlacedText& placed : drawing.texts) {
    if (placed.text == "short" || placed.text[0] == 'w') heights.push_back(placed.rect.height());
  }
  ASSERT_EQ(heights.size(), 2u);
  EXPECT_EQ(heights[0], heights[1]);
}

TEST(Drawing, LeavesLinesTheirPlaceBesideLongLevelsInTheLegend) {
  Plot plot = heat();
  for (auto& level : plot.heat_map->levels) level.legend = std::string(200, 'W');
  plot.lines = {{{{0.0, 1.0}, {10.0, 1.0}}, Tone::series_1, 2.0, {}, "", "a published limit"}};
  const Drawing drawing = drawn(plot);
  EXPECT_TRUE(says(drawing, "a published limit"));
  expectTextsApart(drawing);
}

TEST(Drawing, OfEveryRangeKeepsItsTextsApart) {
  for (const bool logarithmic : {false, true}) {
    for (int e = -6; e <= 6; ++e) {
      Plot plot = empty();
      plot.x = {"Time", "s", logarithmic, 0.0, std::pow(10.0, e)};
      plot.y = {"Share", "%", logarithmic, -std::pow(10.0, e), 0.0};
      if (logarithmic) plot.x.high = plot.y.high = e == 0 ? 0.5 : std::abs(e);
      if (logarithmic) plot.y.low = -std::abs(e) - 0.001;
      expectTextsApart(drawn(plot));
    }
  }
  Plot far = empty();
  far.x = {"CT number", "HU", false, 1e5, 1e5 + 2.0};
  expectTextsApart(drawn(far));
}

TEST(Drawing, IsTheSameEachTimeAndInAnyThread) {
  const Drawing first = drawn(heat());
  Drawing other;
  std::thread([&] { other = drawn(heat()); }).join();
  EXPECT_EQ(first.image, other.image);
}

TEST(Drawing, IsDarkInTheDarkTheme) {
  const Drawing drawing = drawn(heat(), Theme::dark);
  EXPECT_EQ(drawing.image.pixel(2, 2), coloursOf(Theme::dark).background.rgb());
}

TEST(Drawing, RefusesWhatIsNoPlot) {
  const double inf = std::numeric_limits<double>::infinity();
  const auto linear = [](double low, double high) { return Axis{"Force", "N", false, low, high}; };
  const char* const words[] = {"edges",   "edges",   "axis",  "axis",   "level",
                               "outside", "columns", "rows",  "axis",   "axis",
                               "axis",    "axis",    "width", "dashes", "dashes"};
  for (int which = 0; which < 15; ++which) {
    Plot plot = heat();
    if (which == 0) plot.width_px = 100;
    if (which == 1) plot.height_px = 10000;
    if (which == 2) plot.x.high = plot.x.low;
    if (which == 3) plot.y.high = inf;
    if (which == 4) plot.heat_map->cells[0].level = 9;
    if (which == 5) plot.heat_map->cells[0].at.x = 99.0;
    if (which == 6) plot.heat_map->columns = {2.0, 2.0};
    if (which == 7) plot.heat_map->rows = {3.0, 1.0};
    if (which == 8) plot.y = linear(4.0, std::nextafter(4.0, 5.0));
    if (which == 9) plot.y = linear(-1.7e308, 1.7e308);
    if (which == 10) plot.y = linear(0.0, 5e-324);
    if (which == 11) plot.y = linear(std::nan(""), 4.0);
    if (which == 12) plot.lines = {{{}, Tone::ink, 0.0}};
    if (which == 13) plot.lines = {{{}, Tone::ink, 1.0, {5.0, 0.0}}};
    if (which == 14) plot.lines = {{{}, Tone::ink, 1.0, {5.0, 3.0, 2.0}}};
    const Result<Drawing> drawing = draw(plot);
    ASSERT_FALSE(drawing) << which;
    EXPECT_EQ(drawing.error().code.str(), "BAD_ARGUMENT") << which;
    EXPECT_NE(drawing.error().what.find(words[which]), std::string::npos) << which;
  }
}

}  // namespace
}  // namespace trephine::plot
