#include "bench/import/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "unit/lab/import_fixture.h"

namespace trephine::bench {
namespace {

using test::row;

ImportMeasurement madeUp() {
  ImportMeasurement m;
  m.volume_mb = 150.0;
  m.rows = {row("int16", "trephine", 0.12, true),
            row("int16", "trephine command", 0.2, true),
            row("int16", "floor", 0.1, {}),
            row("int16", "floor kept", 0.16, {}),
            row("int16", "dcm2niix", 0.4, true),
            row("u12", "trephine", 0.15, true),
            row("u12", "floor", 0.12, {}),
            row("rle", "trephine command", 0.3, true),
            row("rle", "dcm2niix", 0.5, true),
            row("rle", "dicomtonifti", 0.1, false),
            row("jpegls", "trephine command", {}, false),
            row("jpegls", "dcm2niix", 2.0, true),
            row("jpegll", "trephine command", 1.0, true),
            row("jpegll", "dcm2niix", 4.0, true),
            row("jpegll", "dicomtonifti", 2.0, true),
            row("j2k", "trephine command", 1.0, true),
            row("j2k", "floor", 0.1, {})};
  m.scan = {{3000, "trephine", 0.3, 50.0, ""}, {3000, "gdcmscanner", 0.25, 20.0, ""}};
  return m;
}

TEST(PeerRatios, AreOfMediansOfTheSameRun) {
  const PeerRatios ratios = peerRatiosOf(madeUp());
  EXPECT_NEAR(ratios.command_to_dcm2niix.value(), 0.5, 1e-12);
  EXPECT_NEAR(ratios.scan_to_gdcmscanner.value(), 1.2, 1e-12);
}

TEST(PeerRatios, CompareCompressedSeriesWithTheFastestPeerThatIsRight) {
  const auto compressed = peerRatiosOf(madeUp()).compressed;
  ASSERT_EQ(compressed.size(), 5u);
  const auto of = [&](const std::string& series) {
    return std::find_if(compressed.begin(), compressed.end(),
                        [&](const auto& one) { return one.first == series; })
        ->second;
  };
  EXPECT_NEAR(of("rle").value(), 0.6, 1e-12) << "the faster peer is wrong";
  EXPECT_NEAR(of("jpegll").value(), 0.5, 1e-12) << "the faster of two that are right";
  EXPECT_FALSE(of("jpegls")) << "ours read nothing";
  EXPECT_FALSE(of("j2k")) << "a plain read is no peer";
  EXPECT_FALSE(of("deflated"));
}

TEST(PeerRatios, DoNotCountAWrongVolumeAsRead) {
  ImportMeasurement m = madeUp();
  for (ImportRow& r : m.rows) r.correct = false;
  const PeerRatios ratios = peerRatiosOf(m);
  EXPECT_FALSE(ratios.command_to_dcm2niix);
  for (const auto& [series, value] : ratios.compressed) EXPECT_FALSE(value) << series;
}

TEST(Comparison, FillsInTheRatiosThatTheProductLeavesOut) {
  const Json ours = trephine::toJson(madeUp()), all = bench::toJson(madeUp());
  EXPECT_TRUE(ours["ratios"]["command_to_dcm2niix"].is_null());
  EXPECT_NEAR(all["ratios"]["command_to_dcm2niix"].get<double>(), 0.5, 1e-12);
  EXPECT_NEAR(all["ratios"]["scan_to_gdcmscanner"].get<double>(), 1.2, 1e-12);
  EXPECT_NEAR(all["ratios"]["compressed"]["rle"].get<double>(), 0.6, 1e-12);
  EXPECT_TRUE(all["ratios"]["compressed"]["j2k"].is_null());
  Json rest = all;
  for (const char* key : {"command_to_dcm2niix", "scan_to_gdcmscanner", "compressed"}) {
    ASSERT_TRUE(ours["ratios"].contains(key)) << key;
    rest["ratios"][key] = ours["ratios"][key];
  }
  EXPECT_EQ(rest, ours) << "nothing else differs";
}

TEST(Comparison, ReadsAsATableWithItsRatiosBelow) {
  ImportMeasurement m = madeUp();
  m.rows[4].skipped_reason = "not installed";
  const std::string text = bench::toText(m);
  EXPECT_NE(text.find("not installed"), std::string::npos);
  EXPECT_NE(text.find("scan / gdcmscanner                                         1.20"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("dicomtonifti            1      0.1000          -                 -  NO"),
            std::string::npos)
      << text;
}

}  // namespace
}  // namespace trephine::bench
