#include "machine/trades/recommended.h"

#include <gtest/gtest.h>

#include "base/file.h"
#include "base/system.h"
#include "machine/exercise/explain.h"
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
    EXPECT_EQ(back.error().code.str(), "BAD_FIELD");
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

TEST(Recommended, AMeasurementKeepsTheKnobsThatItLeavesOut) {
  const auto of = [](const char* knob, const char* setting) {
    return RecommendedSetting{knob, setting, 1.0, "%", 2.0, "ns"};
  };
  const std::vector<RecommendedSetting> before{of("grid", "full"),
                                               of("ray_casting", "0.25 voxels")};
  const std::vector<RecommendedSetting> now{of("rate_hz", "1000"), of("grid", "half")};
  const std::vector<RecommendedSetting> expected{of("ray_casting", "0.25 voxels"),
                                                 of("rate_hz", "1000"), of("grid", "half")};
  EXPECT_EQ(renewed(before, now), expected);
}

TEST(Recommended, ThatIsMissingSaysSo) {
  const test::TemporaryFolder folder;
  const auto back = readRecommended(folder / "none.json");
  ASSERT_FALSE(back);
  EXPECT_EQ(back.error().code.str(), "MISSING_FILE");
}

class RecommendedHere : public ::testing::Test {
 protected:
  void put(const std::filesystem::path& folder, const std::string& knob,
           const std::string& setting) {
    const std::vector<RecommendedSetting> one{{knob, setting, 1.0, "%", 2.0, "ns"}};
    ASSERT_TRUE(writeTextFile(folder / "recommended.json", toJson(one).dump()));
  }
  std::string here(const std::string& knob) {
    const auto all = recommendedHere(policy_, own_.path());
    if (!all) return all.error().code.str();
    std::string found;
    for (const RecommendedSetting& s : *all) {
      if (s.knob == knob) found += s.setting + ";";
    }
    return found;
  }
  test::TemporaryFolder own_, hospital_;
  Policy policy_;
};

TEST_F(RecommendedHere, ThePersonsStandOverTheHospitalsOverTheShippedKnobByKnob) {
  const std::string shipped = here("rate_hz"), grid = here("grid");
  ASSERT_FALSE(shipped.empty());
  policy_.folder = hospital_.path();
  EXPECT_EQ(here("rate_hz"), shipped);
  put(hospital_.path(), "rate_hz", "4000");
  EXPECT_EQ(here("rate_hz"), "4000;");
  EXPECT_EQ(here("grid"), grid) << "what one file does not name stands";
  put(own_.path(), "rate_hz", "500");
  EXPECT_EQ(here("rate_hz"), "500;");
  ASSERT_TRUE(writeTextFile(own_ / "recommended.json", "{"));
  EXPECT_EQ(here("rate_hz"), "4000;") << "one that is broken stops nothing";
}

TEST_F(RecommendedHere, NeverTouchWhatTheWorkstationLocks) {
  policy_.folder = hospital_.path();
  put(hospital_.path(), "rate_hz", "4000");
  put(own_.path(), "rate_hz", "500");
  policy_.locks = {Lock::rate};
  EXPECT_EQ(here("rate_hz"), "4000;") << "the hospital's own word on it";
  policy_.rate_hz = 1000.0;
  EXPECT_EQ(here("rate_hz"), "") << "it is prescribed";
  put(own_.path(), "points_blade", "64");
  EXPECT_EQ(here("points_blade"), "64;") << "what is not locked";
}

TEST(ExerciseSettings, AreThoseOfItsToolsForceAndRateEachOnce) {
  Exercise exercise;
  exercise.rate_hz = 2000.0;
  exercise.force_at = ForceAt::distributed;
  exercise.tools = {{"knife", makeBlade(0.016, 33), {}},
                    {"drill", makeBurr(0.003, 64, 8, 0.06), {}},
                    {"needle", makeNeedle(0.08), {}},
                    {"spare", makeBlade(0.016, 17), {}}};
  for (const char* tool : {"knife", "drill", "needle", "knife"}) {
    ExerciseArm arm;
    arm.tool = tool;
    exercise.arms.push_back(arm);
  }
  const std::vector<std::pair<std::string, std::string>> expected{{"points_blade", "33"},
                                                                  {"points_burr", "64"},
                                                                  {"force_at", "distributed"},
                                                                  {"rate_hz", "2000"},
                                                                  {"ray_casting", "0.5 voxels"}};
  EXPECT_EQ(exerciseSettings(exercise), expected);
}

TEST(Recommended, IsWhatTheViewIsDrawnWith) {
  const auto shipped = readRecommended(resourceFolder() / "recommended.json");
  ASSERT_TRUE(shipped) << shipped.error().sentence();
  const std::pair<std::string, std::string> view = exerciseSettings(Exercise()).back();
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
