// The file that says which devices move an exercise's arms.
#include "exercise/arms_file.h"

#include <gtest/gtest.h>

#include <functional>

#include "base/file.h"
#include "base/system.h"
#include "support.h"

namespace trephine {
namespace {

Exercise twoArmedExercise() {
  return *readExercise(resourceFolder() / "scenes" / "cranium.json");
}

Json twoArms() {
  return {{"format", "trephine.arms"},
          {"version", 1},
          {"arms",
           {{{"name", "left"}, {"plugin", "woodenhaptics"}, {"arm", 1}, {"config", "open.json"}},
            {{"name", "right"}, {"plugin", "simulated"}}}}};
}

struct ArmsFile : ::testing::Test {
  Result<std::vector<NamedDevice>> read(const Json& json) {
    EXPECT_TRUE(writeTextFile(folder / "arms.json", json.dump()));
    EXPECT_TRUE(writeTextFile(folder / "open.json", "{}"));
    return readArmsFile(folder / "arms.json");
  }
  // The sentence of the refusal after one change.
  std::string refusal(const std::function<void(Json&)>& change) {
    Json json = twoArms();
    change(json);
    const auto devices = read(json);
    return devices ? "taken" : devices.error().sentence();
  }
  test::TemporaryFolder folder;
};

TEST_F(ArmsFile, GivesTheArmsOfItsNamesTheirDevicesAndTheOthersSimulatedOnes) {
  const auto devices = read(twoArms());
  ASSERT_TRUE(devices) << devices.error().sentence();
  const Exercise exercise = twoArmedExercise();
  const auto rig = rigWith(exercise, *devices, "arms.json");
  ASSERT_TRUE(rig.ok());
  EXPECT_EQ(rig->arms[0].device,
            (ArmDevice{"woodenhaptics", 1, (folder / "open.json").string()}));
  EXPECT_EQ(rig->arms[1].device, (ArmDevice{"simulated", 0, usualArmFile()}))
      << "a simulated one without a file is the usual one";
  const auto one = rigWith(exercise, {(*devices)[0]}, "arms.json");
  ASSERT_TRUE(one.ok());
  EXPECT_EQ(one->arms[1], simulatedRig(exercise).arms[1]);
}

TEST_F(ArmsFile, ASimulatedArmThatIsTakenIsMadeUpForByTheNext) {
  const Exercise exercise = twoArmedExercise();
  ASSERT_EQ(simulatedRig(exercise).arms[1].device.place, 1u);
  const auto rig = rigWith(exercise, {{"left", {"simulated", 1, "mine.json"}}}, "arms.json");
  ASSERT_TRUE(rig.ok());
  EXPECT_EQ(rig->arms[0].device, (ArmDevice{"simulated", 1, "mine.json"}));
  EXPECT_EQ(rig->arms[1].device, (ArmDevice{"simulated", 0, usualArmFile()}));
}

TEST(ExerciseDevices, AnExerciseSaysNothingOfThemAndARecordingDoes) {
  const Exercise exercise = twoArmedExercise();
  for (const Json& written : {exerciseFile(exercise), toJson(exercise)}) {
    for (const Json& arm : written["arms"]) EXPECT_FALSE(arm.contains("device"));
  }
  Json named = exerciseFile(exercise);
  named["arms"][0]["device"] = {{"plugin", "simulated"}, {"arm", 1}};
  const Result<Exercise> refused = parseExercise(named, "exercise.json");
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().sentence().find("device"), std::string::npos);

  RecordedExercise recorded{exercise, simulatedRig(exercise)};
  recorded.rig.arms[0].dynamics = ArmDynamics{0.1, 1e-5, 3.3, 0.0031, 3.3, 0.0};
  const auto again = parseRecordedExercise(toJson(recorded), "the recording");
  ASSERT_TRUE(again.ok()) << again.error().sentence();
  EXPECT_EQ(toJson(*again), toJson(recorded));
  EXPECT_EQ(again->rig.arms[1].device.place, 1u);
  EXPECT_EQ(again->rig.arms[0].dynamics->delay_s, 0.0031);
  // More periods than the loop can know of.
  recorded.rig.arms[0].dynamics->delay_s = 0.017;
  EXPECT_FALSE(parseRecordedExercise(toJson(recorded), "the recording").ok());
  recorded.rig = simulatedRig(exercise);
  recorded.rig.arms[1].device.place = 0;
  const auto twice = parseRecordedExercise(toJson(recorded), "the recording");
  ASSERT_FALSE(twice.ok());
  EXPECT_NE(twice.error().what.find("'right' uses a device that another arm uses"),
            std::string::npos);
}

TEST_F(ArmsFile, AnArmThatTheExerciseDoesNotHaveIsNamedWithThoseThatItHas) {
  const auto used = rigWith(twoArmedExercise(), {{"middle", {"simulated", 0, ""}}}, "arms.json");
  ASSERT_FALSE(used.ok());
  EXPECT_EQ(used.error().code.str(), "NO_SUCH_ARM");
  for (const char* part : {"'middle'", "left, right", "arms.json"}) {
    EXPECT_NE(used.error().sentence().find(part), std::string::npos) << used.error().sentence();
  }
}

TEST_F(ArmsFile, TwoArmsCannotHaveOneDevice) {
  const auto used = rigWith(twoArmedExercise(),
                            {{"left", {"openhaptics", 0, ""}}, {"right", {"openhaptics", 0, ""}}},
                            "arms.json");
  ASSERT_FALSE(used.ok());
  EXPECT_NE(used.error().what.find("one device, 'openhaptics' 0"), std::string::npos);
}

TEST_F(ArmsFile, WhatIsWrongInItIsNamedWithFieldAndValue) {
  const auto expect = [](const std::string& sentence, const char* part) {
    EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("arms.json"), std::string::npos) << sentence;
  };
  expect(refusal([](Json& j) { j["format"] = "trephine.scene"; }), "trephine.scene");
  expect(refusal([](Json& j) { j["version"] = 2; }), "2");
  expect(refusal([](Json& j) { j["arms"][1]["name"] = "left"; }), "'left' stands twice");
  expect(refusal([](Json& j) { j["arms"][0].erase("plugin"); }), "plugin");
  expect(refusal([](Json& j) { j["arms"][0]["plugin"] = ""; }), "no plugin");
  expect(refusal([](Json& j) { j["arms"][0]["name"] = "pedal"; }), "no arm");
  expect(refusal([](Json& j) { j["arms"][0]["arm"] = 64; }), "64");
  expect(refusal([](Json& j) { j["arms"][0]["config"] = "none.json"; }), "none.json");
  expect(refusal([](Json& j) { j["arms"][0]["colour"] = "red"; }), "colour");
  expect(refusal([](Json& j) {
           for (int i = 0; i < 4; ++i) j["arms"].push_back(j["arms"][0]);
         }),
         "4");
  EXPECT_EQ(readArmsFile(folder / "nowhere.json").error().code.str(), "MISSING_FILE");
}

}  // namespace
}  // namespace trephine
