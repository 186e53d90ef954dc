#include "series_fixture.h"

namespace trephine::test {

namespace {

std::string codesIn(const std::filesystem::path& folder) {
  auto ct = CtFolder::scan(folder, Progress());
  if (!ct.ok()) return ct.error().code;
  std::string codes;
  for (const SeriesReport& series : ct->report().series) {
    for (const Finding& finding : series.findings) {
      if (finding.severity == "refusal") codes += (codes.empty() ? "" : " ") + finding.code;
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

TEST(RealData, TheTiltedSkullIsRefusedWithItsAngle) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  auto ct = CtFolder::scan(data / "head-ct-gantry-tilt", Progress());
  ASSERT_TRUE(ct.ok());
  ASSERT_EQ(ct->report().series.size(), 1u);
  EXPECT_NEAR(ct->report().series.front().tilt_deg, 18.5, 0.01);
  EXPECT_NEAR(ct->report().series.front().geometry.spacing_mm.z, 2.371, 0.001);
  EXPECT_EQ(codesIn(data / "head-ct-gantry-tilt"), "GANTRY_TILT");
}

TEST(RealData, EachHardCaseIsRefusedByItsOwnName) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const auto hard = data / "hard";
  EXPECT_EQ(codesIn(hard / "dicom2nifti_failing/gantrytilting"), "GANTRY_TILT");
  EXPECT_EQ(codesIn(hard / "dicom2nifti_failing/notavolume"), "ONE_LOCATION");
  EXPECT_EQ(codesIn(hard / "dicom2nifti_failing/sliceincrement/001"), "MISSING_SLICES");
  EXPECT_EQ(codesIn(hard / "dicom2nifti_failing/sliceincrement/002"), "MISSING_SLICES GANTRY_TILT");
  EXPECT_EQ(codesIn(hard / "philips_scout_and_summary"), "LOCALIZER SECONDARY_CAPTURE");
  EXPECT_EQ(codesIn(hard / "derived_phantom_corrupt/truncated_pixeldata.dcm"),
            "MISSING_SLICES ONE_LOCATION");
}

TEST(RealData, EveryCompressedSyntaxIsNamedWithItsUid) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  for (const auto& [file, name] :
       {std::pair("rle", "RLE Lossless (1.2.840.10008.1.2.5)"),
        std::pair("jpeg_lossless_sv1", "(1.2.840.10008.1.2.4.70)"),
        std::pair("jpegls_near", "(1.2.840.10008.1.2.4.81)"),
        std::pair("j2k_lossless", "JPEG 2000 (Lossless only) (1.2.840.10008.1.2.4.90)")}) {
    auto ct =
        CtFolder::scan(data / "hard/derived_phantom_ts" / (std::string(file) + ".dcm"), Progress());
    ASSERT_TRUE(ct.ok());
    ASSERT_EQ(ct->report().series.size(), 1u) << file;
    const auto& findings = ct->report().series.front().findings;
    const auto named = std::ranges::find(findings, "UNSUPPORTED_TRANSFER_SYNTAX", &Finding::code);
    ASSERT_NE(named, findings.end()) << file;
    EXPECT_NE(named->text.find(name), std::string::npos) << named->text;
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
