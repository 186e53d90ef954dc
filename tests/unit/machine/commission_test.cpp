#include "machine/commission/commission.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <set>

#include "base/file.h"
#include "machine/commission/arm_checks.h"
#include "machine/commission/disk_check.h"
#include "machine/commission/start_check.h"
#include "render/codes.h"
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
                            {"clock", 0.4, std::nan(""), -3.0},
                            {"lateness_2000_normal", 100.0, 900.0, {}},
                            {"lateness_4000_normal", 100.0, 900.0, {}},
                            {"touch_cost", 0.3, 40.0, 150.0},
                            {"screen", 1080.0, 600.0, 400.0},
                            {"arms", 2.0, 1.0, {}},
                            {"arm_encoders", 0.4, 2.0, 20.0},
                            {"arm_forces", 0.5, 0.02, -0.4},
                            {"headset", 1.0, 0.0, {}}};
  EXPECT_EQ(std::size(samples), commissionLimits().size()) << "a row without its sample";
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
       notMeasured("volume_edge", Fitness::fail, {code::kNoDisplay, "No display", "", "Start X"})},
      "2026-11-26 09:30",
      "0.1.0 Release",
      "2 processors",
      {}};
}

TEST(Commissioning, AClockFromBeforeThisVersionFails) {
  EXPECT_EQ(judgedClock(std::time(nullptr), "").verdict, Fitness::pass);
  const CommissionCheck early = judgedClock(std::time_t(1577836800), "2020-01-01 00:00");
  EXPECT_EQ(early.verdict, Fitness::fail);
  EXPECT_LT(*early.value, -5.0);
  EXPECT_EQ(early.next, "Set the clock");
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
  const auto refused = [&](const Json& bad) {
    std::ofstream(folder / "b.json") << bad.dump();
    return !readCommissioning(folder / "b.json");
  };
  EXPECT_TRUE(refused(Json::array()));
  EXPECT_TRUE(refused(Json::object()));
  for (const auto& [key, value] : {std::pair<const char*, Json>("format", "trephine.scene"),
                                   {"version", 2},
                                   {"when", 3},
                                   {"checks", Json::array({1})},
                                   {"checks", Json::array({{{"verdict", "good"}}})}}) {
    Json bad = toJson(now);
    EXPECT_FALSE(refused(bad));
    bad[key] = value;
    EXPECT_TRUE(refused(bad)) << bad.dump();
  }
  EXPECT_EQ(readCommissioning(folder / "none.json").error().code.str(), "MISSING_FILE");
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
  for (const char* part : {"not fit", "Real-time priority", "adduser NAME trephine", "50.0 ms",
                           "at most 33.0 ms", "to practise at all at most 100 ms", "&lt;llvm&gt;",
                           "Start X", "not measured", "For training, not for diagnosis"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(page.find("<llvm>"), std::string::npos);
  EXPECT_NE(toText(now, {}).find("Real-time priority"), std::string::npos);
}

ArmReadings held(double noise_m, double least, double weakest = 0.4, double error = 0.005) {
  return {"an arm", 5.5e-5, MotorEncoderCheck::Phase::done,
          noise_m,  true,   {least, Vec3(0.0, 1.0, 0.0), weakest, error}};
}

TEST(ArmChecks, TheWorstArmCountsAndEachIsNamed) {
  using Checks = std::vector<CommissionCheck>;
  const ArmReadings well = held(2e-5, 0.4);
  const Checks good = judgedArms({well, well});
  EXPECT_EQ(good[0].verdict, Fitness::pass);
  EXPECT_EQ(good[1].verdict, Fitness::pass);
  const Checks noisy = judgedArms({well, held(4e-4, 0.5)});
  EXPECT_EQ(noisy[0].verdict, Fitness::fail);
  EXPECT_NE(noisy[0].remark.find("2, an arm: 0.400 mm"), std::string::npos) << noisy[0].remark;
  const Checks reversed = judgedArms({held(2e-5, -0.4), well});
  EXPECT_EQ(reversed[1].verdict, Fitness::fail);
  EXPECT_EQ(reversed[1].value, -0.4);
  EXPECT_NE(reversed[1].remark.find("-0.40 along (0.0, 1.0, 0.0)"), std::string::npos)
      << reversed[1].remark;
  EXPECT_EQ(judgedArms({held(2e-5, 0.01, 0.01)})[1].verdict, Fitness::warn) << "cut off";
  EXPECT_EQ(judgedArms({held(2e-5, 0.3, 0.01)})[1].verdict, Fitness::warn)
      << "one encoder is stuck";
}

TEST(ArmChecks, WhatPushesDoNotTellForSureNeitherFailsNorPasses) {
  const auto restless = judgedArms({held(2e-5, -0.2, 0.3, 0.15)});
  EXPECT_EQ(restless[1].verdict, Fitness::warn);
  EXPECT_FALSE(restless[1].value);
  EXPECT_NE(restless[1].next.find("still"), std::string::npos) << restless[1].next;
  EXPECT_EQ(judgedArms({held(2e-5, 0.2, 0.3, 0.15)})[1].verdict, Fitness::warn);
  EXPECT_EQ(judgedArms({held(2e-5, -0.6, 0.3, 0.15)})[1].verdict, Fitness::fail);
}

TEST(ArmChecks, AnArmThatNobodyHeldIsNotPassed) {
  ArmReadings untouched{"an arm", 5.5e-5, MotorEncoderCheck::Phase::untouched, 0.0, false, {}};
  const auto checks = judgedArms({held(2e-5, 0.5), untouched});
  for (const CommissionCheck& check : checks) {
    EXPECT_EQ(check.verdict, Fitness::warn) << check.name;
    EXPECT_FALSE(check.value);
    EXPECT_NE(check.next.find("hold each arm"), std::string::npos);
    EXPECT_NE(check.remark.find("nobody held it"), std::string::npos);
  }
  ArmReadings late = untouched;
  late.phase = MotorEncoderCheck::Phase::late;
  for (const CommissionCheck& check : judgedArms({held(2e-5, 0.5), late})) {
    EXPECT_EQ(check.verdict, Fitness::warn) << check.name;
    EXPECT_NE(check.remark.find("ticks came late"), std::string::npos) << check.remark;
    EXPECT_NE(check.next.find("other programs"), std::string::npos) << check.next;
  }
  // One that is reversed is said all the same.
  EXPECT_EQ(judgedArms({held(2e-5, -0.5), untouched})[1].verdict, Fitness::fail);
  ArmReadings scatters = held(2e-3, 0.0);
  scatters.pushed = false;
  const auto bad = judgedArms({scatters});
  EXPECT_EQ(bad[0].verdict, Fitness::fail);
  EXPECT_EQ(bad[1].verdict, Fitness::warn);
}

TEST(DiskCheck, WritesBesideTheCasesKeepsItsTimeAndLeavesNothing) {
  test::TemporaryFolder folder;
  const auto begun = std::chrono::steady_clock::now();
  const auto checks = checkDisk(folder / "not" / "yet", 4'000'000'000, 0.3, Progress());
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(5));
  ASSERT_EQ(checks.size(), 2u);
  EXPECT_EQ(checks[0].name, "disk_room");
  EXPECT_GT(*checks[1].value, 0.0);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(DiskCheck, AFolderThatTheWorkstationIsSetToHasToBeThere) {
  const test::TemporaryFolder folder;
  const StartSurroundings away{folder / "away", true, "none", {}, false};
  for (const CommissionCheck& check : checkDisk(away.storage, 1000, 0.1, Progress(), true)) {
    EXPECT_EQ(check.verdict, Fitness::fail) << check.name;
    EXPECT_NE(check.next.find("disk is connected"), std::string::npos);
  }
  ASSERT_TRUE(storageWords(away));
  EXPECT_EQ(storageWords(away)->fitness, Fitness::fail);
  EXPECT_FALSE(storageWords({folder / "away", false, "none", {}, false})) << "a person's own";
  EXPECT_FALSE(storageWords({folder.path(), true, "none", {}, false}));
}

TEST(StartCheck, SaysOneLineWhetherItIsAsCommissioned) {
  Commissioning before = some();
  before.checks = {judged("disk_room", 100.0), judged("arms", 2.0), judged("screen", 1080.0),
                   judged("opengl", 0.0)};
  EXPECT_NE(startWords({}, {}).words.find("not been commissioned"), std::string::npos);
  const StartWords same = startWords(before, before.checks);
  EXPECT_EQ(same.fitness, Fitness::pass) << "what was a warning then is no news";
  EXPECT_NE(same.words.find("As commissioned on 2026-11-26"), std::string::npos);
  EXPECT_NE(same.all.find("as they were"), std::string::npos);
  Commissioning unfit = before;
  unfit.checks.push_back(judged("frame_time", 300.0));
  const StartWords red = startWords(unfit, before.checks);
  EXPECT_EQ(red.fitness, Fitness::fail) << "it was not fit then, and is not now";
  EXPECT_NE(red.words.find("not fit"), std::string::npos);
  EXPECT_NE(red.all.find("graphics driver"), std::string::npos);
  Commissioning late = before;
  late.checks.push_back(judged("lateness_1000_normal", 900.0));
  EXPECT_EQ(startWords(late, {judged("lateness_1000_normal", 9000.0)}).fitness, Fitness::pass)
      << "ticks that were late are late by another amount each time";
  // Better than it was, and what was not measured then.
  EXPECT_EQ(startWords(before, {judged("opengl", 1.0), judged("disk_write", 1.0)}).fitness,
            Fitness::pass);
  const StartWords gone =
      startWords(before, {judged("arms", 1.0), judged("disk_room", 1.0), judged("screen", 1080.0)});
  EXPECT_EQ(gone.fitness, Fitness::fail);
  EXPECT_NE(gone.words.find("Room in the folder of cases"), std::string::npos) << "the worst first";
  EXPECT_NE(gone.words.find("Free some space"), std::string::npos) << gone.words;
  EXPECT_NE(gone.words.find("(1 more"), std::string::npos);
  EXPECT_NE(gone.all.find("Plug them in"), std::string::npos) << gone.all;
}

TEST(StartCheck, ThePersonsLastCommissioningOrTheHospitalsWhereThatIsNewer) {
  test::TemporaryFolder own, hospital;
  EXPECT_EQ(lastCommissioning(own.path(), hospital.path()).error().code.str(), "NOT_COMMISSIONED");
  Commissioning one = some();
  one.when = "2026-11-20 08:00";
  ASSERT_TRUE(writeTextFile(hospital / "commission.json", toJson(one).dump()));
  EXPECT_EQ(lastCommissioning(own.path(), hospital.path())->when, one.when);
  EXPECT_EQ(lastCommissioning({}, hospital.path())->when, one.when);
  one.when = "2026-11-21 08:00";
  ASSERT_TRUE(writeTextFile(own / "commission.json", toJson(one).dump()));
  EXPECT_EQ(lastCommissioning(own.path(), hospital.path())->when, one.when);
  one.when = "2026-11-22 08:00";
  ASSERT_TRUE(writeTextFile(hospital / "commission.json", toJson(one).dump()));
  EXPECT_EQ(lastCommissioning(own.path(), hospital.path())->when, one.when);
  std::ofstream(hospital / "commission.json") << "{";
  EXPECT_EQ(lastCommissioning(own.path(), hospital.path())->when, "2026-11-21 08:00");
}

TEST(StartCheck, HasWhatCommissioningHasToCompareWith) {
  test::TemporaryFolder folder;
  StartSurroundings here{folder.path(), false, "none", {1920, 1080}, true};
  const auto begun = std::chrono::steady_clock::now();
  const auto checks = checkAtStart(here, Progress());
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  ASSERT_TRUE(checks) << checks.error().sentence();
  std::printf("the check at the start took %.2f s\n", took.count());
  std::set<std::string> names;
  for (const CommissionCheck& check : *checks) names.insert(check.name);
  for (const char* name : {"priority", "disk_room", "disk_write", "arms", "screen"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
  EXPECT_TRUE(names.contains("lateness_1000_fifo") || names.contains("lateness_1000_normal"));
}

}  // namespace
}  // namespace trephine
