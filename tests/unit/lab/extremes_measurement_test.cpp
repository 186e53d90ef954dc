#include "lab/touch/extremes_measurement.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <set>

#include "lab/touch/extremes_rig.h"
#include "support.h"

namespace trephine {
namespace {

using namespace extremes;

constexpr double kLimit_N = 3.3;

// Measured once for all tests.
const ExtremesMeasurement& measured() {
  static const ExtremesMeasurement measurement = *measureExtremes();
  return measurement;
}

// The ordinary stroke, and what is found in it once `change` was made to one tick of its record.
std::string foundAfter(int tick, const std::function<void(TickRecord&)>& change,
                       const std::vector<Event>& events = {}) {
  Run stroke = run({});
  EXPECT_EQ(stroke.broken, "");
  change(stroke.trace[std::size_t(tick)]);
  return brokenBy(stroke.trace, events, kLimit_N);
}

// The fields of a line of CSV; a quote within quotes is doubled.
std::vector<std::string> fieldsOf(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == ',' && !quoted) {
      fields.emplace_back();
    } else if (line[i] != '"') {
      fields.back() += line[i];
    } else if (quoted && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[++i];
    } else {
      quoted = !quoted;
    }
  }
  return fields;
}

TEST(Extremes, EveryOneIsMetAsExpected) {
  for (const ExtremeRow& row : measured().rows) {
    EXPECT_TRUE(row.pass) << row.name << "\n  expected: " << row.expected << "\n  got: " << row.got;
  }
  EXPECT_TRUE(measured().all_pass());
}

TEST(Extremes, AreAllThereAndEachHasItsOwnName) {
  std::set<std::string> names;
  for (const ExtremeRow& row : measured().rows) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    for (const std::string& text : {row.name, row.input, row.expected, row.got}) {
      EXPECT_FALSE(text.empty()) << row.name;
    }
  }
  for (const char* name : {"v exactly 0",
                           "v denormal",
                           "v 1e6 m/s",
                           "b and k 0",
                           "b and k 1e9",
                           "clock back 50 ms",
                           "gap of 10 ms",
                           "jitter of half a period",
                           "clock reads int64's least",
                           "clock reads int64's greatest",
                           "plugin time int64's greatest",
                           "position NaN",
                           "position infinite",
                           "orientation NaN",
                           "tissue parameters not finite",
                           "tool length not finite",
                           "k NaN past validation",
                           "HU -32768 in range",
                           "HU -32768 out of range",
                           "HU 32767 in range",
                           "HU 32767 out of range",
                           "spacing 0.05 mm",
                           "spacing 10 mm",
                           "anisotropy 1:20",
                           "volume 1x1x1",
                           "volume 2048x2048x1",
                           "blade of 0 m",
                           "blade of 1 m",
                           "1 point",
                           "10,000 points",
                           "tool outside the volume",
                           "1e9 ticks at 1 mW",
                           "1e9 ticks in the seed's observer",
                           "device vanishes",
                           "arm lost for a while"}) {
    EXPECT_EQ(names.count(name), 1u) << name;
  }
}

TEST(Extremes, FailTogetherWhenOneFails) {
  ExtremesMeasurement measurement = measured();
  for (ExtremeRow& row : measurement.rows) row.pass = true;
  EXPECT_TRUE(measurement.all_pass());
  measurement.rows[7].pass = false;
  EXPECT_FALSE(measurement.all_pass());
  const std::string text = toText(measurement);
  EXPECT_NE(text.find("FAILS  " + measurement.rows[7].name), std::string::npos);
  EXPECT_NE(text.find("expected: " + measurement.rows[7].expected), std::string::npos);
}

TEST(Extremes, AreWrittenAsOneLineARow) {
  const test::TemporaryFolder folder;
  const auto measurement = measureExtremes(folder / "a" / "b");
  ASSERT_TRUE(measurement) << measurement.error().sentence();
  std::ifstream file(folder / "a" / "b" / "extremes.csv");
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  EXPECT_EQ(line, "name,input,expected,got,pass");
  for (const ExtremeRow& row : measurement->rows) {
    ASSERT_TRUE(std::getline(file, line)) << row.name;
    const std::vector<std::string> fields{row.name, row.input, row.expected, row.got,
                                          row.pass ? "true" : "false"};
    EXPECT_EQ(fieldsOf(line), fields);
  }
  EXPECT_FALSE(std::getline(file, line));
}

TEST(Extremes, AreAnsweredWithExactlyTheirKeys) {
  const ExtremesMeasurement measurement{{{"n", "i", "e", "g", true}, {"m", "j", "f", "h", false}}};
  EXPECT_EQ(toJson(measurement), Json::parse(R"({"rows": [
    {"name": "n", "input": "i", "expected": "e", "got": "g", "pass": true},
    {"name": "m", "input": "j", "expected": "f", "got": "h", "pass": false}]})"));
}

TEST(Extremes, LeaveNoFileWhenTheyAreCancelled) {
  const test::TemporaryFolder folder;
  Progress progress;
  progress.cancel();
  const auto measurement = measureExtremes(folder.path(), progress);
  ASSERT_FALSE(measurement);
  EXPECT_EQ(measurement.error().code.str(), "CANCELLED");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(TraceOfARun, MustSendFiniteForces) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string found = foundAfter(60, [&](TickRecord& r) { r.arms[0].sent_N.y = nan; });
  EXPECT_EQ(found, "a force that is not finite was sent in tick 60");
}

TEST(TraceOfARun, MustStayWithinTheLimitToTheLastBit) {
  const auto send = [](double force_N) {
    return [=](TickRecord& r) { r.arms[0].sent_N = Vec3(0.0, 0.0, force_N); };
  };
  EXPECT_EQ(foundAfter(300, send(kLimit_N)), "");
  EXPECT_EQ(foundAfter(300, send(std::nextafter(kLimit_N, 4.0))),
            "more than the arm's limit was sent in tick 300");
}

TEST(TraceOfARun, MustKeepItsEnergiesFinite) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(foundAfter(9, [&](TickRecord& r) { r.arms[0].energy_out_J.z = inf; }),
            "an energy was not finite in tick 9");
  EXPECT_EQ(foundAfter(9, [&](TickRecord& r) { r.arms[0].observer_J = -inf; }),
            "an energy was not finite in tick 9");
  EXPECT_EQ(foundAfter(9, [&](TickRecord& r) { r.arms[0].credit_J = inf; }),
            "an energy was not finite in tick 9");
}

TEST(TraceOfARun, MustRiseSlowlyAfterTheStartAndAfterEveryCommand) {
  // The stroke has met the law by now and may change its force at once.
  const auto kick = [](TickRecord& r) { r.arms[0].sent_N += Vec3(0.0, 0.6, 0.0); };
  const std::string too_fast = "the force rose by more than 0.05 N after a change in tick ";
  EXPECT_EQ(foundAfter(50, kick), too_fast + "50");
  EXPECT_EQ(foundAfter(300, kick), "");
  const Event resume{280, EventKind::command, -1, 0, {CommandKind::resume, 0, {}}};
  EXPECT_EQ(foundAfter(300, kick, {resume}), too_fast + "300");
}

TEST(TraceOfARun, MustRiseSlowlyUntilItMeetsTheLawHoweverLongThatTakes) {
  auto stroke = run({});
  for (TickRecord& r : stroke.trace) r.arms[0].clamped_N = Vec3(0.0, 0.0, 1.0);
  stroke.trace[300].arms[0].sent_N += Vec3(0.0, 0.6, 0.0);
  EXPECT_NE(brokenBy(stroke.trace, {}, kLimit_N), "");
}

TEST(TraceOfARun, MustNotPushOrCutWhileAFaultStands) {
  const std::string found =
      foundAfter(200, [](TickRecord& r) { r.arms[0].faults = kFaultDeviceLost; });
  EXPECT_EQ(found, "the arm acted in spite of a fault in tick 200");
}

}  // namespace
}  // namespace trephine
