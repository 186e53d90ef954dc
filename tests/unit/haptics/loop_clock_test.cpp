#include "haptics/loop_clock.h"

#include <gtest/gtest.h>

#include "haptics/duration_histogram.h"

namespace trephine {
namespace {

constexpr std::int64_t kT = 1'000'000;

// Sleeps are exact; `delay_ns` is added once to the next wake-up.
struct FakeClock : LoopClock {
  std::int64_t time_ns = 7'000'000'000;
  std::int64_t delay_ns = 0;
  std::int64_t now_ns() override { return time_ns; }
  void sleepUntil(std::int64_t until_ns) override {
    time_ns = until_ns + delay_ns;
    delay_ns = 0;
  }
};

TEST(TickSchedule, KeepsAbsoluteDeadlinesWhateverATickTakes) {
  FakeClock clock;
  TickSchedule schedule(kT);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(schedule.waitForTick(clock), 0);
    EXPECT_EQ(clock.time_ns, 7'000'000'000 + i * kT);
    clock.time_ns += 300'000 + 100 * i;  // work
  }
  EXPECT_EQ(schedule.missed(), 0u);
}

TEST(TickSchedule, ReportsAndForgetsASmallDelay) {
  FakeClock clock;
  TickSchedule schedule(kT);
  schedule.waitForTick(clock);
  clock.delay_ns = 400'000;
  EXPECT_EQ(schedule.waitForTick(clock), 400'000);
  EXPECT_EQ(schedule.missed(), 0u);
  EXPECT_EQ(schedule.waitForTick(clock), 0);
  EXPECT_EQ(clock.time_ns, 7'000'000'000 + 2 * kT);
}

TEST(TickSchedule, CountsMoreThanHalfAPeriodAsMissed) {
  FakeClock clock;
  TickSchedule schedule(kT);
  schedule.waitForTick(clock);
  clock.delay_ns = 600'000;
  EXPECT_EQ(schedule.waitForTick(clock), 600'000);
  EXPECT_EQ(schedule.missed(), 1u);
}

TEST(TickSchedule, DelaysTicksAfterAGapInsteadOfHurryingThroughThem) {
  FakeClock clock;
  TickSchedule schedule(kT);
  schedule.waitForTick(clock);
  clock.delay_ns = 10 * kT;
  EXPECT_EQ(schedule.waitForTick(clock), 10 * kT);
  const std::int64_t after_gap = clock.time_ns;
  EXPECT_EQ(schedule.waitForTick(clock), 0);
  EXPECT_EQ(clock.time_ns, after_gap + kT) << "a full period later, no burst";
}

TEST(TickSchedule, SaysHowLateATickIsHoweverLate) {
  FakeClock clock;
  TickSchedule schedule(kT);
  schedule.waitForTick(clock);
  clock.delay_ns = 2'500'000'000;
  EXPECT_EQ(schedule.waitForTick(clock), 2'500'000'000);
  const std::int64_t after_gap = clock.time_ns;
  EXPECT_EQ(schedule.waitForTick(clock), 0);
  EXPECT_EQ(clock.time_ns, after_gap + kT);
}

TEST(TickSchedule, IsNeverEarlyWhenTheClockGoesBack) {
  FakeClock clock;
  TickSchedule schedule(kT);
  schedule.waitForTick(clock);
  clock.time_ns -= 50 * kT;
  EXPECT_EQ(schedule.waitForTick(clock), 0);
  EXPECT_EQ(clock.time_ns, 7'000'000'000 + kT);
}

TEST(DurationHistogram, GivesMedianAndTailWithinOneBin) {
  DurationHistogram histogram;
  for (int i = 1; i <= 1000; ++i) histogram.add(i * 100);
  const DurationSummary s = histogram.summary();
  EXPECT_NEAR(s.median_ns, 50'000, 50);
  EXPECT_NEAR(s.p99_ns, 99'000, 99);
  EXPECT_NEAR(s.p999_ns, 99'900, 100);
  EXPECT_EQ(s.max_ns, 100'000);
  histogram.add(123'456'789);
  EXPECT_EQ(histogram.summary().max_ns, 123'456'789);
}

// A tool of thousands of points on a slow machine.
TEST(DurationHistogram, GivesThemOfTicksOfMillisecondsAndSecondsToo) {
  for (const double unit_ns : {7.0, 1e6, 1e7}) {
    DurationHistogram histogram;
    for (int i = 1; i <= 1000; ++i) histogram.add(std::int64_t(i * unit_ns));
    const DurationSummary s = histogram.summary();
    EXPECT_NEAR(s.median_ns, 500 * unit_ns, 0.5 * unit_ns + 1) << unit_ns;
    EXPECT_NEAR(s.p99_ns, 990 * unit_ns, unit_ns + 1) << unit_ns;
    EXPECT_NEAR(s.p999_ns, 999 * unit_ns, unit_ns + 1) << unit_ns;
    EXPECT_EQ(s.max_ns, 1000 * unit_ns);
  }
}

TEST(DurationHistogram, CountsWhatIsLongerThanAMinuteAndWhatNoClockCanGive) {
  DurationHistogram histogram;
  histogram.add(-5);
  histogram.add(0);
  histogram.add(std::int64_t(1) << 62);
  EXPECT_EQ(histogram.count(), 3u);
  EXPECT_LE(histogram.summary().median_ns, 1.0);
  EXPECT_EQ(histogram.summary().max_ns, double(std::int64_t(1) << 62));
}

}  // namespace
}  // namespace trephine
