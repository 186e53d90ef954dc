// All of `trephine-measure render`: pictures of a few pixels, seconds of each exercise.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "lab/render/render_measurement.h"
#include "support.h"

namespace trephine {
namespace {

TEST(RenderMeasurement, MeasuresEachCaseByBothMappersAndWritesWhatItDrew) {
  const char* display = std::getenv("DISPLAY");
  if (!display || !*display) GTEST_SKIP() << "No display: this test draws";
  RenderOptions options;
  options.still = {80, 60};
  options.moving = {128, 80};
  options.sample_distances = {0.5, 1.0};
  options.levels = {2.0};
  options.repeats = 1;
  options.rotate_s = 0.2;
  options.cut_s = 3.0;
  options.truth_edge = 64;
  options.truth_step = 8;
  options.surface_edge = 64;
  options.import_size = {32, 32, 12};
  options.case_source = "phantom:abdomen";
  const test::TemporaryFolder folder;
  const auto m = measureRender(options, folder.path());
  ASSERT_TRUE(m) << m.error().sentence();

  using Subject = std::pair<std::string, std::string>;
  std::set<Subject> subjects;
  for (const RenderRow& r : m->rows) {
    EXPECT_GT(r.ms_median, 0.0) << r.mode << " " << r.of_case;
    if (r.mode != "still" || r.width != 80) continue;
    subjects.insert({r.of_case, r.preset});
    if (r.mapper != "trephine") continue;
    // Skipping changes nothing: what is left when all else is off is VTK's own picture.
    EXPECT_GE(r.psnr_to_stock_dB.value_or(0.0), 60.0) << r.of_case << " " << r.preset;
    EXPECT_EQ(std::count_if(m->rows.begin(), m->rows.end(),
                            [&](const RenderRow& other) {
                              return other.mapper == "stock" && other.of_case == r.of_case &&
                                     other.preset == r.preset && other.mode == r.mode &&
                                     other.width == r.width && other.height == r.height &&
                                     other.sample_distance_voxels == r.sample_distance_voxels;
                            }),
              1);
  }
  EXPECT_EQ(subjects, (std::set<Subject>{{"phantom:cranium", "bone"},
                                         {"phantom:cranium", "skin"},
                                         {"phantom:abdomen", "liver"},
                                         {"phantom:abdomen", "bone"}}));
  EXPECT_EQ(m->surface.size(), 2u);
  EXPECT_EQ(m->wrong_class.size(), 4u);
  EXPECT_EQ(m->wrong_class_hu_only.size(), 2u);
  EXPECT_GT(m->first_picture_ms, 0.0);
  EXPECT_FALSE(m->renderer.empty());
  for (const char* file :
       {"render.csv", "bone-phantom-cranium-stock.png", "skin-phantom-cranium-trephine.png",
        "liver-phantom-abdomen-plain.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
  }
}

}  // namespace
}  // namespace trephine
