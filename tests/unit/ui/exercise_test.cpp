#include "ui/frame/exercise.h"

#include <gtest/gtest.h>

#include <QStringList>

#include "haptics/haptic_types.h"
#include "ui/common/words.h"
#include "ui/frame/start_up.h"

namespace trephine {
namespace {

TEST(Percentile, IsTheNearestRank) {
  EXPECT_EQ(percentile({}, 0.5), 0.0);
  EXPECT_EQ(percentile({7.0}, 0.99), 7.0);
  EXPECT_EQ(percentile({3.0, 1.0, 2.0}, 0.5), 2.0);
  std::vector<double> hundred;
  for (int i = 100; i > 0; --i) hundred.push_back(i);
  EXPECT_EQ(percentile(hundred, 0.99), 99.0);
  EXPECT_EQ(percentile(hundred, 1.0), 100.0);
}

TEST(ProcessStart, LiesInThePastAndNotFar) {
  const double ms = msSinceProcessStart();
  EXPECT_GE(ms, 0.0);
  EXPECT_LT(ms, 600000.0);
  EXPECT_GE(msSinceProcessStart(), ms);
}

TEST(ExerciseAnswer, HoldsWhatRunPrintsAndTheWindowsFigures) {
  ExerciseOutcome outcome;
  outcome.report.done.controllers = {"seed"};
  outcome.frames = 3;
  outcome.frame_median_ms = 4.0;
  outcome.frame_p99_ms = 5.0;
  outcome.longest_stall.ms = 6.0;
  outcome.start_ms = 7.0;
  Json json = toJson(outcome);
  for (const char* key : {"start_ms", "frames", "frame_ms", "longest_stall_ms"}) {
    ASSERT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["frames"], 3);
  EXPECT_EQ(json["frame_ms"]["p99"], 5.0);
  for (const char* key :
       {"start_ms", "frames", "frame_ms", "longest_stall_ms", "longest_stall", "session_ms"}) {
    json.erase(key);
  }
  EXPECT_EQ(json, toJson(outcome.report));
}

TEST(Words, EveryFaultIsSaidInASentence) {
  EXPECT_TRUE(faultWords(0).isEmpty());
  for (std::uint32_t fault : {kFaultNonFinite, kFaultLate, kFaultDeviceLost, kFaultStalled,
                              kFaultStuck, kFaultDevice, kFaultDeviceOften}) {
    EXPECT_TRUE(faultWords(fault).endsWith('.')) << fault;
  }
  EXPECT_EQ(faultWords(kFaultNonFinite | kFaultDeviceLost).split('\n').size(), 2);
  EXPECT_EQ(faultWords(kFaultLate | kFaultStalled), faultWords(kFaultStalled))
      << "no promise that the force comes back by itself";
  EXPECT_EQ(faultWords(kFaultDevice | kFaultDeviceOften), faultWords(kFaultDeviceOften));
  EXPECT_EQ(faultWords(kFaultDevice | kFaultDeviceLost), faultWords(kFaultDeviceLost));
  EXPECT_EQ(faultWords(kFaultLate | kFaultDevice).split('\n').size(), 2);
}

TEST(Words, AFindingSaysWhatWasSeenAndWhatWasDone) {
  SeriesReport series;
  EXPECT_TRUE(findingWords(series).isEmpty());
  series.findings.push_back(
      {Code("GAP"), Severity::repair, "A slice is missing", {}, "It was filled"});
  EXPECT_EQ(findingWords(series), "A slice is missing. It was filled.");
}

}  // namespace
}  // namespace trephine
