#include "series_fixture.h"

namespace trephine::test {

namespace {

std::string codesIn(const std::filesystem::path& folder) {
  auto ct = CtFolder::scan(folder, Progress());
  if (!ct.ok()) return ct.error().code.str();
  std::string codes;
  for (const SeriesReport& series : ct->report().series) {
    for (const Finding& finding : series.findings) {
      if (finding.severity == Severity::refusal)
        codes += (codes.empty() ? "" : " ") + finding.code.str();
    }
  }
  return codes;
}

}  // namespace

TEST(RealData, TheSkullPassesWithItsKnownSizeAndRange) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  auto ct = CtFolder::scan(data / "head-ct-plastic-skull", Progress());
  ASSERT_TRUE(ct.ok());
  ASSERT_TRUE(ct->bestSeries().has_value());
  const auto volume = ct->read(*ct->bestSeries(), {}, Progress());
  ASSERT_TRUE(volume.ok());
  const SeriesReport& series = ct->report().series.front();
  EXPECT_EQ(series.verdict, Verdict::pass);
  EXPECT_EQ(volume->geometry.size, (Index3{512, 512, 140}));
  EXPECT_LT(glm::distance(volume->geometry.spacing_mm, Vec3(0.451171875, 0.451171875, 1.0)), 1e-9);
  EXPECT_EQ(series.hu_min, -1024);
  EXPECT_EQ(series.hu_max, 3071);
}

TEST(RealData, TheTiltedSkullIsStraightened) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  auto ct = CtFolder::scan(data / "head-ct-gantry-tilt", Progress());
  ASSERT_TRUE(ct.ok());
  ASSERT_EQ(ct->report().series.size(), 1u);
  EXPECT_NEAR(ct->report().series.front().tilt_deg, 18.5, 0.01);
  EXPECT_NEAR(ct->report().series.front().geometry.spacing_mm.z, 2.371, 0.001);
  EXPECT_EQ(codesIn(data / "head-ct-gantry-tilt"), "");
  const auto volume = ct->read(ct->report().series.front().uid, {}, Progress());
  ASSERT_TRUE(volume.ok());
  EXPECT_EQ(ct->report().series.front().verdict, Verdict::repaired);
  EXPECT_EQ(volume->geometry.size[0], 512);
  EXPECT_GT(volume->geometry.size[1], 512);
}

TEST(RealData, EachHardCaseIsRefusedByItsOwnName) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const auto hard = data / "hard";
  EXPECT_EQ(codesIn(hard / "dicom2nifti_failing/notavolume"), "ONE_LOCATION");
  EXPECT_EQ(codesIn(hard / "dicom2nifti_failing/sliceincrement/001"), "MISSING_SLICES");
  EXPECT_EQ(codesIn(hard / "dicom2nifti_failing/sliceincrement/002"), "MISSING_SLICES");
  EXPECT_EQ(codesIn(hard / "philips_scout_and_summary"), "LOCALIZER SECONDARY_CAPTURE");
  EXPECT_EQ(codesIn(hard / "derived_phantom_corrupt/truncated_pixeldata.dcm"),
            "MISSING_SLICES ONE_LOCATION");
}

// One slice of the phantom in every syntax: the same HU from each that is lossless.
TEST(RealData, EverySyntaxOfThePhantomGivesTheSameHu) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const auto slice = [&](const std::string& name) {
    auto ct = CtFolder::scan(data / "hard/derived_phantom_ts" / (name + ".dcm"), Progress());
    EXPECT_TRUE(ct.ok() && ct->report().series.size() == 1) << name;
    auto picture = ct->slice(ct->report().series.front().uid, 0);
    EXPECT_TRUE(picture.ok()) << name << ": " << picture.error().sentence();
    EXPECT_EQ(ct->report().series.front().lossy,
              name == "jpegls_near" || name == "jpeg_extended12") << name;
    return picture.ok() ? picture->hu : std::vector<std::int16_t>{};
  };
  const auto expected = slice("explicit_le");
  ASSERT_EQ(expected.size(), 512U * 512U);
  for (const char* name : {"implicit_le", "explicit_be", "deflated", "rle", "jpeg_lossless_p14",
                           "jpeg_lossless_sv1", "jpegls_lossless", "j2k_lossless"}) {
    EXPECT_EQ(slice(name), expected) << name;
  }
  for (const char* name : {"jpegls_near", "jpeg_extended12"}) {
    const auto near = slice(name);
    ASSERT_EQ(near.size(), expected.size());
    for (std::size_t n = 0; n < near.size(); n += 7) ASSERT_NEAR(near[n], expected[n], 200) << name;
  }
}

TEST(RealData, NothingInTheHardFoldersStopsAScan) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  auto ct = CtFolder::scan(data, Progress());
  ASSERT_TRUE(ct.ok());
  EXPECT_GT(ct->report().files_read, 250);
  EXPECT_NO_THROW(toJson(ct->report()).dump());
}

}  // namespace trephine::test
