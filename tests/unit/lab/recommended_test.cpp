#include "lab/trades/recommended.h"

#include <gtest/gtest.h>

#include "base/file.h"
#include "base/system.h"
#include "lab/exercise/explain.h"
#include "support.h"

namespace trephine {
namespace {

const std::vector<RecommendedSetting> kTwo{
    {"rate_hz", "1000", 8.5, "% of force", 0.25, "% of a CPU"},
    {"force_at", "tip", 30.0, "% of force", 480.0, "ns"}};

Result<std::vector<RecommendedSetting>> read(const Json& json) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(writeTextFile(folder / "r.json", json.dump()));
  return readRecommended(folder / "r.json");
}

TEST(Recommended, IsReadAsItWasWritten) {
  const Result<std::vector<RecommendedSetting>> back = read(toJson(kTwo));
  ASSERT_TRUE(back) << back.error().sentence();
  EXPECT_EQ(*back, kTwo);
}

TEST(Recommended, ThatIsBrokenIsRefusedByItsField) {
  const Json good = toJson(kTwo);
  const auto refused = [&](const char* field, auto&& change) {
    Json bad = good;
    change(bad);
    const auto back = read(bad);
    ASSERT_FALSE(back) << field;
    EXPECT_EQ(back.error().code, "BAD_FIELD");
    EXPECT_NE(back.error().sentence().find(field), std::string::npos) << back.error().sentence();
  };
  refused("format", [](Json& j) { j["format"] = "trephine.scene"; });
  refused("version", [](Json& j) { j["version"] = 2; });
  refused("setting", [](Json& j) { j["knobs"][1].erase("setting"); });
  refused("cost", [](Json& j) { j["knobs"][0]["cost"] = -1.0; });
  refused("error", [](Json& j) { j["knobs"][0]["error"] = -0.1; });
  refused("knob", [](Json& j) { j["knobs"][1]["knob"] = "rate_hz"; });
  refused("colour", [](Json& j) { j["knobs"][1]["colour"] = "red"; });
}

TEST(Recommended, ThatIsMissingSaysSo) {
  const test::TemporaryFolder folder;
  const auto back = readRecommended(folder / "none.json");
  ASSERT_FALSE(back);
  EXPECT_EQ(back.error().code, "MISSING_FILE");
}

TEST(SceneSettings, AreThoseOfItsToolsForceAndRateEachOnce) {
  Scene scene;
  scene.rate_hz = 2000.0;
  scene.force_at = ForceAt::distributed;
  scene.tools = {{"knife", makeBlade(0.016, 33), {}},
                 {"drill", makeBurr(0.003, 64, 8, 0.06), {}},
                 {"needle", makeNeedle(0.08), {}},
                 {"spare", makeBlade(0.016, 17), {}}};
  for (const char* tool : {"knife", "drill", "needle", "knife"}) {
    SceneArm arm;
    arm.tool = tool;
    scene.arms.push_back(arm);
  }
  const std::vector<std::pair<std::string, std::string>> expected{{"points_blade", "33"},
                                                                  {"points_burr", "64"},
                                                                  {"force_at", "distributed"},
                                                                  {"rate_hz", "2000"},
                                                                  {"ray_casting", "0.5 voxels"}};
  EXPECT_EQ(sceneSettings(scene), expected);
}

TEST(Recommended, IsWhatTheViewIsDrawnWith) {
  const auto shipped = readRecommended(resourceFolder() / "recommended.json");
  ASSERT_TRUE(shipped) << shipped.error().sentence();
  const std::pair<std::string, std::string> view = sceneSettings(Scene()).back();
  ASSERT_EQ(view.first, "ray_casting");
  for (const RecommendedSetting& knob : *shipped) {
    if (knob.knob != view.first) continue;
    EXPECT_EQ(knob.setting, view.second);
    return;
  }
  ADD_FAILURE() << "no row for " << view.first;
}

}  // namespace
}  // namespace trephine
