#include "machine/ticks/jitter_measurement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <limits>
#include <numeric>
#include <sstream>
#include <thread>

#include "base/rt/alloc_guard.h"
#include "support.h"

namespace trephine {
namespace {

using namespace std::chrono_literals;

// Takes no time of its own; the n-th sleep ends n * `delay_ns` late.
struct LateClock : LoopClock {
  std::int64_t time_ns = 7'000'000'000;
  std::int64_t delay_ns = 0;
  std::int64_t sleeps = 0;
  std::int64_t now_ns() override { return time_ns; }
  void sleepUntil(std::int64_t until_ns) override { time_ns = until_ns + ++sleeps * delay_ns; }
};

std::vector<std::string> linesOf(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(JitterSummary, GivesTheQuantilesOfKnownNumbersWhateverTheirOrder) {
  std::vector<std::int64_t> late_ns(2000);
  std::iota(late_ns.rbegin(), late_ns.rend(), 1);
  const JitterRow row = summarizeJitter(2000.0, true, late_ns, 7);
  EXPECT_DOUBLE_EQ(row.median_us, 1.0);
  EXPECT_DOUBLE_EQ(row.p99_us, 1.98);
  EXPECT_DOUBLE_EQ(row.p999_us, 1.998);
  EXPECT_DOUBLE_EQ(row.max_us, 2.0);
  EXPECT_EQ(row.rate_hz, 2000.0);
  EXPECT_TRUE(row.real_time);
  EXPECT_EQ(row.missed, 7u);
  EXPECT_EQ(row.ticks, 2000u);
}

TEST(JitterSummary, NeverCallsALateTickOfFewOrdinary) {
  const JitterRow row = summarizeJitter(1000.0, false, {5000, 1000, 3000}, 0);
  EXPECT_DOUBLE_EQ(row.median_us, 3.0);
  EXPECT_DOUBLE_EQ(row.p99_us, 5.0);
  EXPECT_DOUBLE_EQ(row.p999_us, 5.0);
  EXPECT_DOUBLE_EQ(row.max_us, 5.0);
}

TEST(JitterSummary, OfNoTicksIsZero) {
  const JitterRow row = summarizeJitter(1000.0, false, {}, 0);
  EXPECT_EQ(row.ticks, 0u);
  EXPECT_EQ(row.max_us, 0.0);
}

TEST(JitterRow, OfKnownLatenessHasItsQuantilesAndMisses) {
  LateClock clock;
  clock.delay_ns = 1000;
  const Result<JitterRow> row = measureJitterRow(1000.0, false, 1.0, clock, Progress());
  ASSERT_TRUE(row) << row.error().sentence();
  // The first tick is on time by definition: 0 to 999 us in steps of 1 us.
  EXPECT_DOUBLE_EQ(row->median_us, 499.0);
  EXPECT_DOUBLE_EQ(row->p99_us, 989.0);
  EXPECT_DOUBLE_EQ(row->p999_us, 998.0);
  EXPECT_DOUBLE_EQ(row->max_us, 999.0);
  EXPECT_EQ(row->missed, 499u) << "501 to 999 us are later than half a period";
  EXPECT_FALSE(row->real_time);
}

TEST(JitterRow, CountsAllTicksAtTheRateThatItSays) {
  for (double rate_hz : {1000.0, 2000.0, 4000.0}) {
    LateClock clock;
    const std::int64_t begin_ns = clock.time_ns;
    const Result<JitterRow> row = measureJitterRow(rate_hz, false, 0.3, clock, Progress());
    ASSERT_TRUE(row) << row.error().sentence();
    EXPECT_EQ(row->rate_hz, rate_hz);
    EXPECT_EQ(row->ticks, std::uint64_t(0.3 * rate_hz + 0.5));
    EXPECT_EQ(row->max_us, 0.0);
    EXPECT_EQ(row->missed, 0u);
    EXPECT_EQ(clock.time_ns - begin_ns, std::int64_t(row->ticks - 1) * std::int64_t(1e9 / rate_hz));
  }
}

TEST(JitterRow, AllocatesNothingWhileItTicks) {
  const std::uint64_t before = rt::guardedAllocations();
  LateClock clock;
  ASSERT_TRUE(measureJitterRow(1000.0, false, 1.0, clock, Progress()));
  EXPECT_EQ(rt::guardedAllocations(), before);
}

TEST(JitterRow, ReportsProgressOfItsPartOnTheCallersThread) {
  std::vector<double> fractions;
  const std::thread::id caller = std::this_thread::get_id();
  const Progress progress([&](double fraction, const std::string& step) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    EXPECT_EQ(step, "1000 Hz normal");
    fractions.push_back(fraction);
  });
  HostClock clock;
  ASSERT_TRUE(measureJitterRow(1000.0, false, 0.3, clock, progress, 0.25, 0.5));
  EXPECT_GE(fractions.size(), 3u) << "at the begin, on the way and at the end";
  EXPECT_EQ(fractions.front(), 0.25);
  EXPECT_EQ(fractions.back(), 0.5);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
}

TEST(JitterRow, StopsSoonAfterItIsCancelledFromAnotherThread) {
  std::atomic<int> told{0};
  Progress progress([&](double, const std::string&) { ++told; });
  std::chrono::steady_clock::time_point cancelled_at;
  std::jthread canceller([&] {
    EXPECT_TRUE(test::waitUntil([&] { return told >= 2; })) << "at the begin, and on the way";
    cancelled_at = std::chrono::steady_clock::now();
    progress.cancel();
  });
  HostClock clock;
  const Result<JitterRow> row = measureJitterRow(4000.0, false, 600.0, clock, progress);
  const auto returned_at = std::chrono::steady_clock::now();
  canceller.join();
  ASSERT_FALSE(row);
  EXPECT_EQ(row.error().code.str(), "CANCELLED");
  EXPECT_LT(returned_at - cancelled_at, 2s) << "0.2 s, and room for a busy machine";
}

TEST(JitterMeasurement, RefusesATimeThatIsTooShortTooLongOrNone) {
  const test::TemporaryFolder folder;
  for (double seconds : {0.0, -1.0, 0.099, 600.1, std::numeric_limits<double>::infinity(),
                         std::numeric_limits<double>::quiet_NaN()}) {
    const Result<JitterMeasurement> measured = measureJitter({seconds}, folder / "out");
    ASSERT_FALSE(measured) << seconds;
    EXPECT_EQ(measured.error().code.str(), "BAD_ARGUMENT");
    EXPECT_NE(measured.error().sentence().find("0.1 and 600"), std::string::npos);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(JitterMeasurement, HasEveryRateAndSaysHowToGetAPriorityThatItHadNot) {
  const test::TemporaryFolder folder;
  const Result<JitterMeasurement> measured = measureJitter({0.1}, folder / "a" / "b");
  ASSERT_TRUE(measured) << measured.error().sentence();
  std::vector<double> normal_hz, fifo_hz;
  for (const JitterRow& row : measured->rows) {
    (row.real_time ? fifo_hz : normal_hz).push_back(row.rate_hz);
    EXPECT_EQ(row.ticks, std::uint64_t(0.1 * row.rate_hz + 0.5));
    EXPECT_LE(row.median_us, row.p99_us);
    EXPECT_LE(row.p99_us, row.p999_us);
    EXPECT_LE(row.p999_us, row.max_us);
    EXPECT_GT(row.max_us, 0.0);
  }
  const std::vector<double> all_hz{1000.0, 2000.0, 4000.0};
  EXPECT_EQ(normal_hz, all_hz);
  EXPECT_EQ(fifo_hz, measured->advice.empty() ? all_hz : std::vector<double>());

  const std::vector<std::string> lines = linesOf(folder / "a" / "b" / "jitter.csv");
  ASSERT_EQ(lines.size(), 1 + measured->rows.size());
  EXPECT_EQ(lines[0], "rate_hz,priority,median_us,p99_us,p999_us,max_us,missed,ticks");
  EXPECT_EQ(lines.back().rfind("4000,normal,", 0), 0u) << lines.back();
  for (const std::string& line : lines) EXPECT_EQ(std::count(line.begin(), line.end(), ','), 7);
}

TEST(JitterMeasurement, LeavesNoFileWhenItIsCancelled) {
  const test::TemporaryFolder folder;
  Progress* to_cancel = nullptr;
  Progress progress([&](double fraction, const std::string&) {
    if (fraction > 0.0) to_cancel->cancel();
  });
  to_cancel = &progress;
  const Result<JitterMeasurement> measured = measureJitter({60.0}, folder.path(), progress);
  ASSERT_FALSE(measured);
  EXPECT_EQ(measured.error().code.str(), "CANCELLED");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(JitterMeasurement, SaysBeforeItMeasuresThatTheFolderCannotBeMade) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  bool began = false;
  const Progress progress([&](double, const std::string&) { began = true; });
  const Result<JitterMeasurement> measured = measureJitter({0.1}, folder / "file", progress);
  ASSERT_FALSE(measured);
  EXPECT_EQ(measured.error().code.str(), "CANNOT_WRITE");
  EXPECT_FALSE(began);
}

TEST(JitterMeasurement, IsAnsweredWithExactlyItsKeys) {
  JitterMeasurement measurement;
  measurement.rows.push_back({1000.0, true, 1.5, 2.5, 3.5, 4.5, 6, 5000});
  measurement.rows.push_back({4000.0, false, 0.5, 0.5, 0.5, 0.5, 0, 20000});
  const Json expected = Json::parse(R"({
    "rows": [
      {"rate_hz": 1000.0, "priority": "fifo",
       "late_us": {"median": 1.5, "p99": 2.5, "p999": 3.5, "max": 4.5}, "missed": 6, "ticks": 5000},
      {"rate_hz": 4000.0, "priority": "normal",
       "late_us": {"median": 0.5, "p99": 0.5, "p999": 0.5, "max": 0.5}, "missed": 0, "ticks": 20000}
    ],
    "advice": null})");
  EXPECT_EQ(toJson(measurement), expected);
  measurement.advice = "Log in again.";
  EXPECT_EQ(toJson(measurement)["advice"], "Log in again.");
}

TEST(JitterMeasurement, ReadsAsATableWithItsAdviceBelow) {
  JitterMeasurement measurement;
  measurement.rows.push_back({4000.0, false, 1.5, 2.5, 3.5, 123.4, 6, 20000});
  measurement.advice = "Log in again.";
  std::istringstream text(toText(measurement));
  std::string head, row, advice;
  std::getline(text, head);
  std::getline(text, row);
  std::getline(text, advice);
  EXPECT_EQ(head.size(), row.size());
  EXPECT_NE(row.find("4000 Hz  normal"), std::string::npos) << row;
  EXPECT_NE(row.find("123.4"), std::string::npos) << row;
  EXPECT_EQ(advice, "Log in again.");
}

}  // namespace
}  // namespace trephine
