#include "machine/trades/trades_measurement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <set>

#include "base/system.h"
#include "machine/trades/recommended.h"
#include "machine/trades/trade_knobs.h"
#include "machine/trades/trade_stroke.h"
#include "support.h"
#include "thorough.h"
#include "trade_rows.h"

namespace trephine {
namespace {

using test::row;

TradeRow rate(const char* setting, double error, double cost, double bone_percent = 50.0) {
  return row("rate_hz", setting, error, cost, {{"bone_of_k_max_percent", bone_percent}});
}

// The settings that are recommended.
std::vector<std::string> chosen(std::vector<TradeRow> rows) {
  recommend(rows);
  std::vector<std::string> out;
  for (const TradeRow& r : rows) {
    if (r.recommended) out.push_back(r.setting);
  }
  return out;
}

TradesOptions small() {
  TradesOptions options;
  options.blade_points = {2, 8, 32};
  options.burr_points = {8, 64};
  options.rates_hz = {250.0, 1000.0};
  options.grid = 128;
  options.stroke_s = 1.0;
  options.strokes = 3;
  options.ray_distances = {0.5, 2.0};
  options.ray_picture = {96, 80};
  options.reference_step = 12;
  return options;
}

// Without a display no rays are cast.
bool measuredHere(std::string_view knob) {
  const char* display = std::getenv("DISPLAY");
  return knob != "ray_casting" || (display && *display);
}
std::size_t knobsHere() {
  return std::size_t(std::count_if(kKnobs.begin(), kKnobs.end(),
                                   [](const Knob& knob) { return measuredHere(knob.id); }));
}

using Chosen = std::vector<std::string>;

TEST(Recommend, TakesTheCheapestThatIsGoodEnough) {
  // force_at tolerates 10.
  EXPECT_EQ(chosen({row("force_at", "a", 10.1, 1.0), row("force_at", "b", 10.0, 3.0),
                    row("force_at", "c", 2.0, 2.0), row("force_at", "d", 0.0, 9.0)}),
            Chosen{"c"});
}

TEST(Recommend, TakesTheTruestWhereNoneIsGoodEnough) {
  EXPECT_EQ(chosen({row("force_at", "a", 40.0, 1.0), row("force_at", "b", 30.0, 3.0)}),
            Chosen{"b"});
}

TEST(Recommend, HoldsARateToItsShareOfTheProcessor) {
  EXPECT_EQ(chosen({rate("slow", 12.0, 1.0), rate("right", 9.0, 24.9), rate("dear", 1.0, 25.1)}),
            Chosen{"right"});
  // Good enough only beyond the limit: the truest within it.
  EXPECT_EQ(chosen({rate("slow", 12.0, 1.0), rate("next", 11.0, 2.0), rate("dear", 1.0, 25.1)}),
            Chosen{"next"});
  EXPECT_EQ(chosen({rate("a", 12.0, 30.0), rate("b", 11.0, 40.0)}), Chosen{"b"});
}

TEST(Recommend, HoldsARateToWhatItLeavesOfTheArmsStiffness) {
  EXPECT_EQ(chosen({rate("slow", 9.0, 1.0, 61.0), rate("right", 9.0, 2.0, 60.0)}), Chosen{"right"});
}

TEST(Recommend, HoldsPointsToTheirVolumeToo) {
  EXPECT_EQ(chosen({row("points_blade", "few", 1.0, 1.0, {{"volume_error_percent", 5.1}}),
                    row("points_blade", "none said", 1.0, 1.5),
                    row("points_blade", "more", 2.0, 2.0, {{"volume_error_percent", 5.0}})}),
            Chosen{"more"});
}

TEST(Recommend, HoldsRaysToTheWorstPicture) {
  const auto rays = [](const char* setting, double cost, double rms_percent) {
    return row("ray_casting", setting, 2.0, cost,
               {{"luminance_error_percent", 1.5}, {"picture_rms_percent", rms_percent}});
  };
  EXPECT_EQ(chosen({rays("fine", 3.0, 0.6), rays("coarse", 1.0, 1.1), rays("next", 2.0, 1.0)}),
            Chosen{"next"});
}

TEST(Recommend, MarksExactlyOneOfEachKnobAndNoneOfAnUnknownOne) {
  EXPECT_EQ(chosen({row("points_burr", "x", 0.1, 1.0), row("points_burr", "y", 0.1, 1.0),
                    row("force_at", "z", 1.0, 1.0), row("colour", "red", 0.0, 0.0)}),
            (Chosen{"x", "z"}));
}

TEST(Recommend, IsNotAskedOfACostOrErrorThatIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(chosen({rate("nan", nan, nan), rate("a", 9.0, 2.0)}), Chosen{"a"});
}

TEST(RmsError, IsOfTheReferencesSize) {
  const std::vector<Vec3> truth{{3.0, 0.0, 0.0}, {0.0, 4.0, 0.0}};
  EXPECT_NEAR(rmsError_percent({{3.0, 0.0, 5.0}, {0.0, 4.0, 0.0}}, truth), 100.0, 1e-9);
  EXPECT_EQ(rmsError_percent(truth, truth), 0.0);
  EXPECT_EQ(rmsError_percent(truth, {Vec3(0.0), Vec3(0.0)}), 100.0);
  EXPECT_EQ(rmsError_percent({Vec3(0.0)}, {Vec3(0.0)}), 0.0);
}

TEST(PointsKnob, ErrorFallsAndCostGrowsWithTheirNumber) {
  TradesOptions options = small();
  const TradeRows rows = tradePoints(ToolKind::blade, {2, 32}, options, Progress());
  ASSERT_TRUE(rows);
  ASSERT_EQ(rows->size(), 2u);
  EXPECT_GT((*rows)[0].error, 3.0 * (*rows)[1].error);
  EXPECT_GT((*rows)[1].error, 0.0);
  EXPECT_LT((*rows)[0].cost, (*rows)[1].cost);
  EXPECT_LT((*rows)[1].extraOf("volume_error_percent"), 10.0);
  EXPECT_NE((*rows)[0].reference.find("256 points"), std::string::npos);
}

TEST(ForceAtKnob, DistributedIsNearerToTheLineIntegral) {
  TradesOptions options = small();
  options.grid = 256;
  const TradeRows rows = tradeForceAt(options, Progress());
  ASSERT_TRUE(rows);
  ASSERT_EQ(rows->size(), 2u);
  EXPECT_EQ((*rows)[0].setting, "tip");
  EXPECT_GT((*rows)[0].error, 25.0);
  EXPECT_LT((*rows)[1].error, 15.0);
  EXPECT_GT((*rows)[1].error, 0.0);
}

TEST(RateKnob, ASlowRateIsFartherFromTheTruthAndCostsLess) {
  const TradeRows rows = tradeRate(small(), Progress());
  ASSERT_TRUE(rows);
  ASSERT_EQ(rows->size(), 2u);
  const TradeRow &slow = (*rows)[0], &usual = (*rows)[1];
  EXPECT_EQ(slow.setting, "250");
  EXPECT_GT(slow.error, 2.0 * usual.error);
  EXPECT_LT(slow.extraOf("b_max_Ns_per_m"), usual.extraOf("b_max_Ns_per_m"));
  EXPECT_NEAR(usual.cost, 100.0 * usual.extraOf("tick_ns") * 1e-9 * 1000.0, 1e-9);
}

TEST(RateKnob, TellsRatesApartThatAnEncoderHides) {
  TradesOptions options = small();
  options.rates_hz = {1000.0, 20000.0};
  const TradeRows rows = tradeRate(options, Progress());
  ASSERT_TRUE(rows);
  const TradeRow &usual = (*rows)[0], &fast = (*rows)[1];
  EXPECT_GT(usual.error, 2.0 * fast.error);
  EXPECT_GT(fast.extraOf("with_encoder_percent"), 3.0 * fast.error);
}

TEST(Strokes, AreStatedByTheirNinetiethPercentile) {
  std::vector<double> errors;
  for (int n = 20; n > 0; --n) errors.push_back(n);
  const StrokeErrors of = overStrokes(errors);
  EXPECT_EQ(of.stated, 18.0);
  EXPECT_EQ(of.median, 10.0);
  EXPECT_EQ(of.most, 20.0);
}

// What is stated of a setting, and what other strokes come to. Both are twelve strokes of one
// distribution: that the median of the one passes the 90th percentile of the other happens once in
// 70 times. What is recommended is good enough for the other strokes too.
void expectStated(std::string_view knob_id, const TradeRows& stated, const TradeRows& other,
                  const std::vector<RecommendedSetting>& recommended) {
  ASSERT_TRUE(stated);
  ASSERT_TRUE(other);
  const auto knob =
      std::find_if(kKnobs.begin(), kKnobs.end(), [&](const Knob& of) { return of.id == knob_id; });
  ASSERT_NE(knob, kKnobs.end()) << knob_id;
  const auto chosen =
      std::find_if(recommended.begin(), recommended.end(),
                   [&](const RecommendedSetting& of) { return of.knob == knob_id; });
  ASSERT_NE(chosen, recommended.end()) << knob_id;
  bool met = false;
  for (std::size_t n = 0; n < stated->size(); ++n) {
    const TradeRow &a = (*stated)[n], &b = (*other)[n];
    std::printf(
        "%-12s %-12s stated %6.2f, median %6.2f, most %6.2f; other strokes: %6.2f, %6.2f, "
        "%6.2f\n",
        std::string(knob_id).c_str(), a.setting.c_str(), a.error, a.extraOf("error_median"),
        a.extraOf("error_most"), b.error, b.extraOf("error_median"), b.extraOf("error_most"));
    EXPECT_LE(b.extraOf("error_median"), a.error) << knob_id << ' ' << a.setting;
    EXPECT_LE(a.extraOf("error_median"), b.error) << knob_id << ' ' << a.setting;
    if (a.setting != chosen->setting) continue;
    met = true;
    EXPECT_LE(b.error, knob->tolerance) << knob_id << ' ' << a.setting;
  }
  EXPECT_TRUE(met) << knob_id << ' ' << chosen->setting << " was not among those measured";
}

TEST(StatedErrors, HoldForStrokesThatWereNotAmongThose) {
  if (!test::thoroughly(true, false)) GTEST_SKIP() << "of the label slow";
  const auto file = readRecommended(resourceFolder() / "recommended.json");
  ASSERT_TRUE(file) << file.error().sentence();
  TradesOptions options, others;
  options.rates_hz = others.rates_hz = {500.0, 1000.0, 4000.0};
  others.first_stroke = 1000;
  const Progress progress;
  const auto points = [&](ToolKind kind, const std::vector<int>& counts, const char* name) {
    expectStated(name, tradePoints(kind, counts, options, progress),
                 tradePoints(kind, counts, others, progress), *file);
  };
  points(ToolKind::blade, {8, 32, 128}, "points_blade");
  points(ToolKind::burr, {16, 128, 512}, "points_burr");
  expectStated("force_at", tradeForceAt(options, progress), tradeForceAt(others, progress), *file);
  expectStated("rate_hz", tradeRate(options, progress), tradeRate(others, progress), *file);
  expectStated("grid", tradeGrid(options, progress), tradeGrid(others, progress), *file);
}

// The product's own file. What a setting costs depends on the machine.
TEST(StatedErrors, AreThoseOfTheFileThatShips) {
  if (!test::thoroughly(true, false)) GTEST_SKIP() << "of the label slow";
  if (!measuredHere("ray_casting")) GTEST_SKIP() << "there is no display";
  const auto file = readRecommended(resourceFolder() / "recommended.json");
  ASSERT_TRUE(file) << file.error().sentence();
  const auto now = measureTrades(TradesOptions{});
  ASSERT_TRUE(now) << now.error().sentence();
  const std::vector<RecommendedSetting> made = recommendedOf(now->rows);
  ASSERT_EQ(made.size(), file->size());
  for (std::size_t n = 0; n < made.size(); ++n) {
    const RecommendedSetting &is = made[n], &stands = (*file)[n];
    EXPECT_EQ(is.knob, stands.knob);
    EXPECT_EQ(is.setting, stands.setting) << is.knob;
    EXPECT_NEAR(is.error, stands.error, 0.02 * stands.error + 0.01) << is.knob;
    EXPECT_EQ(is.error_unit, stands.error_unit) << is.knob;
    EXPECT_EQ(is.cost_unit, stands.cost_unit) << is.knob;
  }
}

TEST(GridKnob, AveragesInPlace) {
  Volume fine;
  fine.geometry.size = {4, 2, 2};
  fine.geometry.spacing_mm = {1.0, 2.0, 3.0};
  fine.geometry.origin_mm = {10.0, 20.0, 30.0};
  for (int n = 0; n < 16; ++n) fine.hu.push_back(std::int16_t(n % 4 < 2 ? 100 : 10 * n));
  const Volume coarse = averaged(fine, 2);
  EXPECT_EQ(coarse.geometry.size, (Index3{2, 1, 1}));
  EXPECT_EQ(coarse.geometry.spacing_mm, Vec3(2.0, 4.0, 6.0));
  EXPECT_EQ(coarse.geometry.origin_mm, Vec3(10.5, 21.0, 31.5));  // the middle of 8 voxels
  // 2 3 6 7 10 11 14 15, times 10.
  EXPECT_EQ(coarse.hu, (Voxels{100, 85}));
  EXPECT_EQ(averaged(fine, 1).hu, fine.hu);
}

TEST(GridKnob, CoarserIsWorseAndSmaller) {
  const TradeRows rows = tradeGrid(small(), Progress());
  ASSERT_TRUE(rows);
  ASSERT_EQ(rows->size(), 3u);
  EXPECT_EQ((*rows)[0].cost, 4.0);  // 128^3 of two bytes, in MB of 2^20
  EXPECT_EQ((*rows)[1].cost, 0.5);
  EXPECT_EQ((*rows)[2].cost, 0.0625);
  EXPECT_EQ((*rows)[0].error, 0.0);
  EXPECT_EQ((*rows)[0].extraOf("surface_distance_mm"), 0.0);
  EXPECT_GT((*rows)[0].extraOf("removed_mm3"), 20.0);
  // 4 W for a second, and for the 0.4 s of the way there, at 0.06 J/mm3.
  EXPECT_LT((*rows)[0].extraOf("removed_mm3"), 93.4);
  const double half_mm = (*rows)[1].extraOf("surface_distance_mm");
  EXPECT_GT(half_mm, 0.0);
  EXPECT_GT((*rows)[2].extraOf("surface_distance_mm"), half_mm);
  EXPECT_LT((*rows)[2].extraOf("surface_distance_mm"), 1.6);
}

TEST(Trades, MeasureEveryKnobAndRecommendOneSettingEach) {
  const test::TemporaryFolder folder;
  const Result<TradesMeasurement> m = measureTrades(small(), folder / "a" / "b");
  ASSERT_TRUE(m) << m.error().sentence();
  std::map<std::string, int> recommended;
  for (const TradeRow& r : m->rows) {
    recommended[r.knob] += r.recommended;
    EXPECT_GE(r.error, 0.0) << r.knob;
    EXPECT_GT(r.cost, 0.0) << r.knob;
    EXPECT_FALSE(r.reference.empty() || r.error_unit.empty() || r.cost_unit.empty()) << r.knob;
  }
  EXPECT_EQ(recommended.size(), knobsHere());
  for (const Knob& knob : kKnobs) {
    EXPECT_EQ(recommended[std::string(knob.id)], measuredHere(knob.id) ? 1 : 0) << knob.id;
  }

  std::ifstream csv(folder / "a" / "b" / "trades.csv");
  std::size_t lines = 0;
  for (std::string line; std::getline(csv, line);) ++lines;
  EXPECT_EQ(lines, 1 + m->rows.size());
  const auto table = readTrades(folder / "a" / "b" / "trades.json");
  ASSERT_TRUE(table) << table.error().sentence();
  EXPECT_EQ(toJson(*table), toJson(*m));
  const auto saved = readRecommended(folder / "a" / "b" / "recommended.json");
  ASSERT_TRUE(saved) << saved.error().sentence();
  ASSERT_EQ(saved->size(), knobsHere());
  for (const RecommendedSetting& s : *saved) {
    const auto is = [&](const TradeRow& r) {
      return r.recommended && r.knob == s.knob && r.setting == s.setting && r.error == s.error;
    };
    EXPECT_TRUE(std::any_of(m->rows.begin(), m->rows.end(), is)) << s.knob;
  }
}

TEST(Trades, RefuseWhatCannotBeBeforeTheyMakeAFolder) {
  const test::TemporaryFolder folder;
  std::vector<TradesOptions> bad(10, small());
  bad[0].blade_points = {};
  bad[1].burr_points = {1};
  bad[2].blade_points = {2048};
  bad[3].rates_hz = {};
  bad[4].rates_hz = {3000.0};
  bad[5].rates_hz = {std::numeric_limits<double>::quiet_NaN()};
  bad[6].grid = 130;
  bad[7].stroke_s = 0.1;
  bad[8].ray_distances = {0.0};
  bad[9].strokes = 0;
  for (const TradesOptions& options : bad) {
    const Result<TradesMeasurement> m = measureTrades(options, folder / "out");
    ASSERT_FALSE(m) << &options - bad.data();
    EXPECT_EQ(m.error().code.str(), "BAD_ARGUMENT");
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(Trades, LeaveNoFileWhenTheyAreCancelledAtAnyKnob) {
  std::vector<std::string> knobs;
  for (const Knob& knob : kKnobs) {
    if (measuredHere(knob.id)) knobs.emplace_back(knob.id);
  }
  // The first, one in the middle and the last, unless all are wanted.
  const std::size_t step =
      test::thoroughly<std::size_t>(1, std::max<std::size_t>(1, (knobs.size() - 1) / 2));
  for (std::size_t n = 0; n < knobs.size(); n += step) {
    const std::string& knob = knobs[n];
    const test::TemporaryFolder folder;
    Progress* to_cancel = nullptr;
    Progress progress([&](double, const std::string& at) {
      if (at == knob) to_cancel->cancel();
    });
    to_cancel = &progress;
    const Result<TradesMeasurement> m = measureTrades(small(), folder.path(), progress);
    ASSERT_FALSE(m) << knob;
    EXPECT_EQ(m.error().code.str(), "CANCELLED");
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  }
}

TEST(Trades, EveryKnobStopsByItself) {
  Progress progress;
  progress.cancel();
  const TradesOptions options = small();
  for (const TradeRows& rows :
       {tradePoints(ToolKind::burr, {8}, options, progress), tradeForceAt(options, progress),
        tradeRate(options, progress), tradeGrid(options, progress)}) {
    ASSERT_FALSE(rows);
    EXPECT_EQ(rows.error().code.str(), "CANCELLED");
  }
}

TEST(Trades, SayBeforeTheyMeasureThatTheFolderCannotBeMade) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  bool began = false;
  const Progress progress([&](double, const std::string&) { began = true; });
  const Result<TradesMeasurement> m = measureTrades(small(), folder / "file", progress);
  ASSERT_FALSE(m);
  EXPECT_EQ(m.error().code.str(), "CANNOT_WRITE");
  EXPECT_FALSE(began);
}

TEST(Trades, AreAnsweredWithExactlyTheirKeys) {
  TradesMeasurement m;
  m.rows = {row("rate_hz", "1000", 8.5, 0.25, {{"b_max_Ns_per_m", 128.0}})};
  m.rows[0].recommended = true;
  EXPECT_EQ(toJson(m), Json::parse(R"({"rows": [{
    "knob": "rate_hz", "setting": "1000", "error": 8.5, "error_unit": "%", "cost": 0.25,
    "cost_unit": "ns", "reference": "truth", "recommended": true,
    "extra": {"b_max_Ns_per_m": 128.0}}]})"));
  const std::string text = toText(m);
  EXPECT_NE(text.find("Rate of touch (error: truth)"), std::string::npos) << text;
  EXPECT_NE(text.find("* 1000"), std::string::npos) << text;
}

}  // namespace
}  // namespace trephine
