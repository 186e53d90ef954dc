#include "lab/render/render_measurement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "support.h"

namespace trephine {
namespace {

RenderRow pictureRow(const char* mapper, double ms) {
  RenderRow r;
  r.of_case = "phantom:cranium";
  r.preset = "bone";
  r.width = 800;
  r.height = 600;
  r.mode = "still";
  r.mapper = mapper;
  r.sample_distance_voxels = 0.5;
  r.ms_median = ms;
  return r;
}

RenderMeasurement pictures() {
  RenderMeasurement m;
  RenderRow ours = pictureRow("trephine", 500.0);
  ours.ms_plain_median = 450.0;
  ours.psnr_dB = 40.0;
  ours.ssim = 0.99;
  ours.psnr_to_stock_dB = 71.0;
  m.rows = {ours, pictureRow("stock", 7000.0)};
  RenderRow turning = pictureRow("trephine", 50.0);
  turning.mode = "rotate";
  turning.width = 1280;
  turning.height = 800;
  turning.level = 2.5;
  m.rows.push_back(turning);
  m.rests = {{"phantom:cranium", "bone", 80.0, 1400.0}};
  m.surface = {{"stock", 5.0, 17.0, 8.0}, {"trephine", 1.5, 4.0, 1.5}};
  m.wrong_class = {{"phantom:cranium", "trephine", 3.0}};
  m.first_picture_ms = 900.0;
  m.renderer = "llvmpipe";
  return m;
}

std::set<std::string> keysOf(const Json& object) {
  std::set<std::string> keys;
  for (const auto& item : object.items()) keys.insert(item.key());
  return keys;
}

std::set<std::string> failing(const RenderMeasurement& m) {
  std::set<std::string> names;
  for (const RenderBar& bar : renderBars(m)) {
    if (!bar.pass()) names.insert(bar.name);
  }
  return names;
}

TEST(RenderReport, HasEveryKeyAndNullForWhatWasNotMeasured) {
  const Json json = toJson(pictures());
  EXPECT_EQ(keysOf(json), (std::set<std::string>{"rows", "surface", "wrong_class_percent",
                                                 "wrong_class_hu_only_percent",
                                                 "removal_to_pixel_ms", "hand_to_tool_pixel_ms",
                                                 "first_picture_ms", "renderer", "bars"}));
  const Json& first = json["rows"][0];
  EXPECT_EQ(keysOf(first),
            (std::set<std::string>{"case", "preset", "size", "mode", "mapper",
                                   "sample_distance_voxels", "level", "ms_median",
                                   "ms_plain_median", "psnr_db", "ssim", "psnr_to_stock_db"}));
  EXPECT_EQ(first["size"], (Json{800, 600}));
  EXPECT_EQ(first["psnr_to_stock_db"], 71.0);
  EXPECT_TRUE(json["rows"][1]["ms_plain_median"].is_null());
  EXPECT_EQ(json["surface"][1]["normal_error_deg"], (Json{{"median", 1.5}, {"p99", 4.0}}));
  EXPECT_EQ(json["wrong_class_percent"][0],
            (Json{{"case", "phantom:cranium"}, {"mapper", "trephine"}, {"value", 3.0}}));
}

TEST(RenderReport, BarsAreMetOrMissedByTheFiguresOfTheRun) {
  EXPECT_EQ(failing(pictures()), std::set<std::string>{});
  RenderMeasurement m = pictures();
  m.rows[1].ms_median = 5900.0;  // 11.8 times
  EXPECT_EQ(failing(m), std::set<std::string>{"bone, phantom:cranium: times as fast as stock"});
  m = pictures();
  m.rows[0].psnr_to_stock_dB = 59.0;
  m.rows[0].ms_plain_median = 390.0;
  EXPECT_EQ(failing(m),
            (std::set<std::string>{"bone, phantom:cranium: plain picture against stock [dB]",
                                   "bone, phantom:cranium: frame against the plain one"}));
  m = pictures();
  m.rows[2].ms_median = 70.0;
  m.rows[2].level = 3.25;
  m.rests[0].full_ms = 1600.0;
  m.wrong_class[0].percent = 4.5;
  m.surface[1].of.normal_p99_deg = 7.5;
  EXPECT_EQ(failing(m).size(), 5u);
}

TEST(RenderReport, TheTableHasALineForEachRow) {
  const std::string table = toCsv(pictures());
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4);
  EXPECT_NE(toText(pictures()).find("llvmpipe"), std::string::npos);
}

TEST(RenderMeasurement, RefusesWhatCannotBeBeforeItMakesAFolder) {
  const test::TemporaryFolder folder;
  std::vector<RenderOptions> bad(4);
  bad[0].sample_distances = {};
  bad[1].sample_distances = {0.0};
  bad[2].repeats = 0;
  bad[3].still = {0, 600};
  for (const RenderOptions& options : bad) {
    const auto m = measureRender(options, folder / "out");
    ASSERT_FALSE(m) << &options - bad.data();
    EXPECT_EQ(m.error().code.str(), "BAD_ARGUMENT");
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

}  // namespace
}  // namespace trephine
