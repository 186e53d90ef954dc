#include "lab/commission/commission.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <set>

#include "base/file.h"
#include "support.h"

namespace trephine {
namespace {

TEST(CommissionLimits, EachHasAReasonANextStepAndAFailureBeyondItsWarning) {
  std::set<std::string> names;
  for (const CommissionLimit& each : commissionLimits()) {
    EXPECT_TRUE(names.insert(each.name).second) << each.name;
    for (const char* text : {each.words, each.unit, each.reason, each.next}) {
      EXPECT_GT(std::string(text).size(), 1u) << each.name;
    }
    if (each.fail) {
      EXPECT_TRUE(each.at_least ? *each.fail <= each.warn : *each.fail >= each.warn) << each.name;
    }
  }
}

struct Sample {
  const char* name;
  double pass, warn;
  std::optional<double> fail;
};

// What each machine here lacks: a loaded core, no priority, memory that is not held, no card, a
// full disk.
TEST(CommissionLimits, EachCheckCanPassWarnAndFail) {
  const Sample samples[] = {{"lateness_1000_fifo", 40.0, 300.0, 900.0},
                            {"lateness_2000_fifo", 40.0, 300.0, {}},
                            {"lateness_4000_fifo", 40.0, 300.0, {}},
                            {"lateness_1000_normal", 100.0, 900.0, {}},
                            {"priority", 1.0, 0.0, {}},
                            {"locked_memory", 1e6, 8.0, {}},
                            {"opengl", 1.0, 0.0, {}},
                            {"volume_edge", 2048.0, std::nan(""), 256.0},
                            {"frame_time", 12.0, 60.0, 400.0},
                            {"removal_to_pixel", 40.0, 150.0, 400.0},
                            {"hand_to_tool", 30.0, 90.0, 300.0},
                            {"disk_write", 300.0, 20.0, 1.0},
                            {"disk_room", 100.0, 10.0, 1.0},
                            {"memory", 20.0, 3.0, 1.0},
                            {"clock", 0.4, std::nan(""), -3.0}};
  for (const Sample& sample : samples) {
    EXPECT_EQ(judged(sample.name, sample.pass).verdict, Fitness::pass) << sample.name;
    EXPECT_TRUE(judged(sample.name, sample.pass).next.empty()) << sample.name;
    if (std::isfinite(sample.warn)) {
      const CommissionCheck warned = judged(sample.name, sample.warn);
      EXPECT_EQ(warned.verdict, Fitness::warn) << sample.name;
      EXPECT_FALSE(warned.next.empty()) << sample.name;
    }
    if (sample.fail) {
      const CommissionCheck failed = judged(sample.name, *sample.fail);
      EXPECT_EQ(failed.verdict, Fitness::fail) << sample.name;
      EXPECT_EQ(failed.limit, commissionLimit(sample.name)->fail) << sample.name;
    }
  }
  const CommissionCheck small = judged("volume_edge", 1024.0, "", 1300.0);
  EXPECT_EQ(small.verdict, Fitness::fail) << "a case that is kept here is larger";
  EXPECT_EQ(small.limit, 1300.0);
  EXPECT_FALSE(small.next.empty());
  const CommissionCheck none = judged("frame_time", std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(none.verdict, Fitness::fail) << "a figure that is none is no pass";
  EXPECT_FALSE(none.value);
}

Commissioning some() {
  return {
      {judged("disk_room", 100.0), judged("priority", 0.0), judged("frame_time", 50.0, "<llvm>"),
       notMeasured("volume_edge", Fitness::fail, {"NO_DISPLAY", "No display", "", "Start X"})},
      "2026-11-26 09:30",
      "0.1.0 Release",
      "2 processors"};
}

TEST(Commissioning, IsReadAsItWasWritten) {
  test::TemporaryFolder folder;
  const Commissioning now = some();
  ASSERT_TRUE(writeTextFile(folder / "a.json", toJson(now).dump()));
  const Result<Commissioning> read = readCommissioning(folder / "a.json");
  ASSERT_TRUE(read) << read.error().sentence();
  EXPECT_EQ(toJson(*read), toJson(now));
  EXPECT_EQ(fitnessOf(*read), Fitness::fail);
  EXPECT_TRUE(changesSince(*read, now).empty());
  for (const char* bad : {"[]", "{}", R"({"when":"","build":"","machine":"","checks":[1]})",
                          R"({"when":"","build":"","machine":"","checks":[{"verdict":"good"}]})"}) {
    std::ofstream(folder / "b.json") << bad;
    EXPECT_FALSE(readCommissioning(folder / "b.json")) << bad;
  }
  EXPECT_EQ(readCommissioning(folder / "none.json").error().code, "MISSING_FILE");
}

TEST(Commissioning, SaysWhatIsOtherwiseThanTheLastTime) {
  const Commissioning before = some();
  Commissioning now = before;
  now.checks[0] = judged("disk_room", 1.0);    // full
  now.checks[1] = judged("priority", 1.0);     // granted since
  now.checks[2] = judged("frame_time", 90.0);  // slower, and a warning as before
  const auto changes = changesSince(before, now);
  ASSERT_EQ(changes.size(), 3u);
  EXPECT_EQ(changes[0].now, Fitness::fail);
  EXPECT_EQ(changes[1].now, Fitness::pass);
  EXPECT_EQ(changes[2].value_before, 50.0);
  now = before;
  now.checks[0] = judged("disk_room", 60.0);  // less, and enough
  now.checks[2] = judged("frame_time", 55.0);
  EXPECT_TRUE(changesSince(before, now).empty());
}

TEST(Commissioning, ThePageNamesEachCheckItsLimitAndTheNextStepInPlainWords) {
  const Commissioning now = some();
  const std::string page = toHtml(now, changesSince(now, now));
  for (const char* part :
       {"not fit", "Real-time priority", "group trephine", "50.0 ms", "at most 33.0 ms",
        "&lt;llvm&gt;", "Start X", "not measured", "For training, not for diagnosis"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(page.find("<llvm>"), std::string::npos);
  EXPECT_NE(toText(now, {}).find("Real-time priority"), std::string::npos);
}

}  // namespace
}  // namespace trephine
