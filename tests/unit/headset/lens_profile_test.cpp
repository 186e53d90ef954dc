// A lens's profile: what is read, what is refused, and where a pixel is taken from.
#include "headset/lens_profile.h"

#include <gtest/gtest.h>

#include <fstream>

namespace trephine {
namespace {

Result<LensProfile> read(const std::string& text) {
  const auto file = std::filesystem::path(::testing::TempDir()) / "lens.json";
  std::ofstream(file) << text;
  return readLensProfile(file);
}

TEST(LensProfile, SaysWhereEachColourOfAPixelIsTakenFrom) {
  const auto lens = read(
      R"({"format": "trephine.lens", "version": 1, "k": [0.2, 0.1, 0.0],
          "colour": [0.99, 1.0, 1.01], "axis": 0.1})");
  ASSERT_TRUE(lens) << lens.error().sentence();
  const glm::dvec2 at(0.6, 0.0);
  EXPECT_NEAR(lensSource(*lens, 0, 1, at).x, 0.1 + 0.5 * (1.0 + 0.2 * 0.25 + 0.1 * 0.0625), 1e-12);
  EXPECT_NEAR(lensSource(*lens, 1, 1, {-0.6, 0.0}).x, -lensSource(*lens, 0, 1, at).x, 1e-12);
  EXPECT_LT(lensSource(*lens, 0, 0, at).x, lensSource(*lens, 0, 1, at).x);
  EXPECT_GT(lensSource(*lens, 0, 2, at).x, lensSource(*lens, 0, 1, at).x);
  EXPECT_EQ(lensSource(*lens, 0, 1, {0.1, 0.0}), glm::dvec2(0.1, 0.0)) << "the axis stays";
  const auto none = read(R"({"format": "trephine.lens", "version": 1})");
  ASSERT_TRUE(none);
  EXPECT_EQ(lensSource(*none, 1, 2, {0.3, -0.9}), glm::dvec2(0.3, -0.9));
}

TEST(LensProfile, NonsenseIsRefusedInWords) {
  for (const char* bad : {"", "[]", R"({"format": "trephine.scene", "version": 1})",
                          R"({"format": "trephine.lens", "version": 1, "k": [0.1, 0.1]})",
                          R"({"format": "trephine.lens", "version": 1, "k": [1e9, 0, 0]})",
                          R"({"format": "trephine.lens", "version": 1, "k": [-2.0, 0, 0]})",
                          R"({"format": "trephine.lens", "version": 1, "colour": [1, 1, "blue"]})",
                          R"({"format": "trephine.lens", "version": 1, "axes": 0.1})"}) {
    const auto lens = read(bad);
    ASSERT_FALSE(lens) << bad;
    EXPECT_NE(lens.error().where.find("lens.json"), std::string::npos) << lens.error().sentence();
    EXPECT_FALSE(lens.error().next.empty()) << lens.error().sentence();
  }
  EXPECT_FALSE(readLensProfile("/nowhere/lens.json"));
}

}  // namespace
}  // namespace trephine
