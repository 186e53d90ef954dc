#include "lab/touch/haptics_measurement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <numeric>
#include <set>

#include "machine/common/shell_phantom.h"
#include "support.h"

namespace trephine {
namespace {

HapticsRow row(const char* tool, int grid, double box_mm, TouchPhase phase, double mean_ns,
               double p999_ns = 0.0) {
  HapticsRow r;
  r.tool = tool;
  r.arms = 2;
  r.grid = grid;
  r.box_mm = box_mm;
  r.phase = phase;
  r.mean_ns = r.median_ns = mean_ns;
  r.p999_ns = p999_ns;
  r.ran = r.ticks = 100;
  if (phase != TouchPhase::free) r.touched = 100;
  if (phase == TouchPhase::removal) r.removed_mm3_per_s = 1.0;
  return r;
}

HapticsOptions small() {
  HapticsOptions options;
  options.ticks = 600;
  options.grids = {128};
  options.boxes_mm = {49.2};
  options.sliding = {64, 1, 0.05, 0.0};
  return options;
}

std::size_t linesIn(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::size_t lines = 0;
  for (std::string line; std::getline(in, line);) ++lines;
  return lines;
}

TEST(HapticsRow, HasTheQuantilesOfKnownTimes) {
  std::vector<double> ns(2000);
  std::iota(ns.rbegin(), ns.rend(), 1.0);
  const HapticsRow r = summarizeTicks(ns, row("needle", 64, 200.0, TouchPhase::contact, 0.0));
  EXPECT_EQ(r.mean_ns, 1000.5);
  EXPECT_EQ(r.median_ns, 1000.0);
  EXPECT_EQ(r.p99_ns, 1980.0);
  EXPECT_EQ(r.p999_ns, 1998.0);
  EXPECT_EQ(r.max_ns, 2000.0);
  EXPECT_EQ(r.ticks, 2000u);
  EXPECT_EQ(r.tool, "needle");
  EXPECT_EQ(summarizeTicks({}, {}).max_ns, 0.0);
}

TEST(HapticsRow, IsOfItsPhaseOnlyWhereItDidThat) {
  HapticsRow r = row("needle", 64, 200.0, TouchPhase::free, 1.0);
  EXPECT_TRUE(isOfItsPhase(r));
  r.touched = 1;
  EXPECT_FALSE(isOfItsPhase(r));
  r = row("needle", 64, 200.0, TouchPhase::contact, 1.0);
  EXPECT_TRUE(isOfItsPhase(r));
  r.touched = 99;
  EXPECT_FALSE(isOfItsPhase(r));
  r = row("needle", 64, 200.0, TouchPhase::removal, 1.0);
  EXPECT_TRUE(isOfItsPhase(r));
  r.removed_mm3_per_s = 0.0;
  EXPECT_FALSE(isOfItsPhase(r));
}

TEST(HapticsBars, AreHeldAgainstTheirRows) {
  HapticsMeasurement m;
  m.sliding = {3.0, 8.0, 3.0, 0.0, 1};
  m.rows = {row("burr6", 512, 49.2, TouchPhase::removal, 15000.0, 150000.0),
            row("burr6", 256, 49.2, TouchPhase::removal, 10000.0),
            row("blade64", 512, 200.0, TouchPhase::contact, 5000.0)};
  std::vector<HapticsBar> bars = hapticsBars(m);
  ASSERT_EQ(bars.size(), 8u);
  for (const HapticsBar& bar : bars) EXPECT_TRUE(bar.pass()) << bar.name << ' ' << bar.value;

  m.rows[0].mean_ns = 20100.0;
  m.rows[0].p999_ns = 150001.0;
  m.rows[0].removed_mm3_per_s = 0.0;
  m.rows[2].mean_ns = 5001.0;
  m.sliding = {3.01, 8.01, 3.01, 0.0, 1};
  bars = hapticsBars(m);
  for (const HapticsBar& bar : bars) EXPECT_FALSE(bar.pass()) << bar.name << ' ' << bar.value;
}

TEST(HapticsBars, OfRowsThatWereNotMeasuredAreLeftOut) {
  HapticsMeasurement m;
  EXPECT_EQ(hapticsBars(m).size(), 4u);
  m.rows = {row("burr6", 512, 49.2, TouchPhase::contact, 1.0)};
  EXPECT_EQ(hapticsBars(m).size(), 4u);
}

TEST(HapticsRow, OfRemovalLeavesTheGridAsItWasThoughItTookVoxels) {
  const test::TemporaryFolder folder;
  Grid grid(shellTop(128, 49.2));
  const std::string before = volumeSha256(grid.snapshot());
  HapticsRow asked = row("burr6", 128, 49.2, TouchPhase::removal, 0.0);
  asked.touched = 0;
  const Result<HapticsRow> measured = measureHapticsRow(asked, grid, 1000, folder.path());
  ASSERT_TRUE(measured) << measured.error().sentence();
  EXPECT_EQ(volumeSha256(grid.snapshot()), before);
  // Two motors of 4 W on tissue of 0.06 J/mm3 can take 133 mm3 a second, and the hands' work a
  // little more.
  EXPECT_GT(measured->removed_mm3_per_s, 60.0);
  EXPECT_LT(measured->removed_mm3_per_s, 145.0);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(HapticsRow, ThatIsCancelledIsNoRow) {
  const test::TemporaryFolder folder;
  Grid grid(shellTop(32, 49.2));
  Progress progress;
  progress.cancel();
  const Result<HapticsRow> measured = measureHapticsRow(
      row("needle", 32, 49.2, TouchPhase::free, 0.0), grid, 100, folder.path(), progress);
  ASSERT_FALSE(measured);
  EXPECT_EQ(measured.error().code.str(), "CANCELLED");
}

TEST(HapticsMeasurement, RunsEveryToolArmAndPhase) {
  const test::TemporaryFolder folder;
  const Result<HapticsMeasurement> m = measureHaptics(small(), folder / "a" / "b");
  ASSERT_TRUE(m) << m.error().sentence();
  ASSERT_EQ(m->rows.size(), 18u);
  std::set<std::string> seen;
  for (const HapticsRow& r : m->rows) {
    seen.insert(r.tool + std::to_string(r.arms) + touchPhaseName(r.phase));
    EXPECT_TRUE(isOfItsPhase(r)) << r.tool << ' ' << touchPhaseName(r.phase) << ' ' << r.touched;
    EXPECT_GT(r.median_ns, 0.0);
    EXPECT_LE(r.median_ns, r.p99_ns);
    EXPECT_LE(r.p999_ns, r.max_ns);
  }
  EXPECT_EQ(seen.size(), 18u);
  EXPECT_EQ(linesIn(folder / "a" / "b" / "haptics.csv"), 19u);
}

TEST(HapticsMeasurement, RefusesWhatCannotBeBeforeItMakesAFolder) {
  const test::TemporaryFolder folder;
  std::vector<HapticsOptions> bad(5, small());
  bad[0].ticks = 99;
  bad[1].grids = {};
  bad[2].grids = {128, 4096};
  bad[3].boxes_mm = {40.0};
  bad[4].boxes_mm = {std::nan("")};
  for (const HapticsOptions& options : bad) {
    const Result<HapticsMeasurement> m = measureHaptics(options, folder / "out");
    ASSERT_FALSE(m);
    EXPECT_EQ(m.error().code.str(), "BAD_ARGUMENT");
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(HapticsMeasurement, LeavesNoFileWhenItIsCancelled) {
  const test::TemporaryFolder folder;
  Progress* to_cancel = nullptr;
  Progress progress([&](double fraction, const std::string&) {
    if (fraction > 0.3) to_cancel->cancel();
  });
  to_cancel = &progress;
  const Result<HapticsMeasurement> m = measureHaptics(small(), folder.path(), progress);
  ASSERT_FALSE(m);
  EXPECT_EQ(m.error().code.str(), "CANCELLED");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(HapticsMeasurement, SaysBeforeItMeasuresThatTheFolderCannotBeMade) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  bool began = false;
  const Progress progress([&](double, const std::string&) { began = true; });
  const Result<HapticsMeasurement> m = measureHaptics(small(), folder / "file", progress);
  ASSERT_FALSE(m);
  EXPECT_EQ(m.error().code.str(), "CANNOT_WRITE");
  EXPECT_FALSE(began);
}

TEST(HapticsMeasurement, WithoutAFolderOfItsOwnNeedsTheTemporaryOne) {
  const test::Environment missing("TMPDIR", "/no/such/folder");
  const Result<HapticsMeasurement> m = measureHaptics(small(), {});
  ASSERT_FALSE(m);
  EXPECT_EQ(m.error().code.str(), "NO_TEMPORARY_FOLDER");
}

TEST(HapticsMeasurement, IsAnsweredWithExactlyItsKeys) {
  HapticsMeasurement m;
  m.rows = {row("blade64", 256, 49.2, TouchPhase::removal, 1500.0, 3500.0)};
  m.rows[0].p99_ns = 2500.0;
  m.rows[0].max_ns = 4500.0;
  m.sliding = {1.5, 6.5, 0.5, -2.0, 10};
  Json answer = toJson(m);
  const Json bars = answer["bars"];
  answer.erase("bars");
  EXPECT_EQ(answer, Json::parse(R"({
    "rows": [{"tool": "blade64", "arms": 2, "grid": 256, "box_mm": 49.2, "phase": "removal",
              "ns": {"mean": 1500.0, "median": 1500.0, "p99": 2500.0, "p999": 3500.0, "max": 4500.0},
              "removed_mm3_per_s": 1.0, "ticks": 100}],
    "direction_error_deg": {"median": 1.5, "p99": 6.5},
    "sliding_force_step_percent_p99": 0.5,
    "depth_error_percent": -2.0})"));
  ASSERT_EQ(bars.size(), 4u);
  EXPECT_EQ(bars[0]["value"], 1.5);
  EXPECT_EQ(bars[0]["limit"], 3.0);
  EXPECT_EQ(bars[0]["pass"], true);
}

TEST(HapticsMeasurement, ReadsAsATableWithItsBarsBelow) {
  HapticsMeasurement m;
  m.rows = {row("blade64", 512, 200.0, TouchPhase::contact, 5100.0)};
  const std::string text = toText(m);
  EXPECT_NE(text.find("blade64  2 arms  512^3 200.0 mm contact"), std::string::npos) << text;
  EXPECT_NE(text.find("FAIL"), std::string::npos) << text;
  EXPECT_NE(text.find("pass"), std::string::npos) << text;
}

}  // namespace
}  // namespace trephine
