// The file that says which devices move a scene's arms.
#include "scene/arms_file.h"

#include <gtest/gtest.h>

#include <functional>

#include "base/file.h"
#include "base/system.h"
#include "support.h"

namespace trephine {
namespace {

Scene twoArmedScene() {
  return *readScene(resourceFolder() / "scenes" / "cranium.json");
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

TEST_F(ArmsFile, GivesTheArmsOfItsNamesTheirDevicesAndTheOthersKeepTheirs) {
  const auto devices = read(twoArms());
  ASSERT_TRUE(devices) << devices.error().sentence();
  Scene scene = twoArmedScene();
  const Scene before = scene;
  ASSERT_TRUE(useArms(scene, *devices, "arms.json").ok());
  EXPECT_EQ(scene.arms[0].device.plugin, "woodenhaptics");
  EXPECT_EQ(scene.arms[0].device.place, 1u);
  EXPECT_EQ(scene.arms[0].device.config, (folder / "open.json").string());
  EXPECT_EQ(scene.arms[1].device.plugin, "simulated");
  EXPECT_EQ(scene.arms[1].device.place, 0u);
  EXPECT_EQ(scene.arms[1].device.config, (resourceFolder() / "devices" / "omni.json").string())
      << "a simulated one without a file is the usual one";
  scene = before;
  ASSERT_TRUE(useArms(scene, {(*devices)[0]}, "arms.json").ok());
  EXPECT_EQ(scene.arms[1].device, before.arms[1].device);
}

TEST_F(ArmsFile, ASimulatedArmThatIsTakenIsMadeUpForByTheNext) {
  Scene scene = twoArmedScene();
  ASSERT_EQ(scene.arms[1].device.place, 1u);
  ASSERT_TRUE(useArms(scene, {{"left", {"simulated", 1, "mine.json"}}}, "arms.json").ok());
  EXPECT_EQ(scene.arms[0].device, (ArmDevice{"simulated", 1, "mine.json"}));
  EXPECT_EQ(scene.arms[1].device.plugin, "simulated");
  EXPECT_EQ(scene.arms[1].device.place, 0u);
}

TEST(SceneDevices, EachArmOfAnExerciseHasASimulatedOneUntilTheWorkstationNamesAnother) {
  const Scene scene = twoArmedScene();
  const std::string omni = (resourceFolder() / "devices" / "omni.json").string();
  EXPECT_FALSE(scene.names_devices);
  for (std::uint32_t i = 0; i < 2; ++i) {
    EXPECT_EQ(scene.arms[i].device, (ArmDevice{"simulated", i, omni}));
  }
  Json json = sceneFile(scene);
  for (const Json& arm : json["arms"]) EXPECT_FALSE(arm.contains("device"));
}

TEST(SceneDevices, ADeviceInAnOlderExerciseIsItsArmsDefaultAndSavingLeavesItOut) {
  Json json = sceneFile(twoArmedScene());
  json["arms"][0]["device"] = {{"plugin", "simulated"}, {"arm", 1}};
  const Result<Scene> scene = parseScene(json, "older.json");
  ASSERT_TRUE(scene) << scene.error().sentence();
  EXPECT_TRUE(scene->names_devices);
  EXPECT_EQ(scene->arms[0].device, (ArmDevice{"simulated", 1, ""}));
  EXPECT_EQ(scene->arms[1].device.place, 0u) << "the next that nobody has";
  EXPECT_FALSE(sceneFile(*scene)["arms"][0].contains("device"));
  EXPECT_EQ(toJson(*scene)["arms"][0]["device"]["arm"], 1) << "a recording says what moved it";
}

TEST_F(ArmsFile, AnArmThatTheSceneDoesNotHaveIsNamedWithThoseThatItHas) {
  Scene scene = twoArmedScene();
  const Status used = useArms(scene, {{"middle", {"simulated", 0, ""}}}, "arms.json");
  ASSERT_FALSE(used);
  EXPECT_EQ(used.error().code, "NO_SUCH_ARM");
  for (const char* part : {"'middle'", "left, right", "arms.json"}) {
    EXPECT_NE(used.error().sentence().find(part), std::string::npos) << used.error().sentence();
  }
}

TEST_F(ArmsFile, TwoArmsCannotHaveOneDevice) {
  Scene scene = twoArmedScene();
  const Status used = useArms(
      scene, {{"left", {"openhaptics", 0, ""}}, {"right", {"openhaptics", 0, ""}}}, "arms.json");
  ASSERT_FALSE(used);
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
  EXPECT_EQ(readArmsFile(folder / "nowhere.json").error().code, "MISSING_FILE");
}

}  // namespace
}  // namespace trephine
