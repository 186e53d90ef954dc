// Volumes that are no DICOM, with the same report card.
#include <array>
#include <limits>

#include "series_fixture.h"

namespace trephine::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPlace =
    R"(, "origin_mm": [0, 0, 0], "direction": [1, 0, 0, 0, 1, 0, 0, 0, 1])";

class FileSeries : public SeriesFixture {
 protected:
  FileSeries() { fs::create_directory(folder()); }

  // NAME.raw of float voxels, 2 x 2 to a slice, with NAME.json.
  void writeRaw(const std::string& name, const std::vector<float>& values,
                const std::string& more = kPlace) {
    const char* bytes = reinterpret_cast<const char*>(values.data());
    writeBytes(folder() / (name + ".raw"), std::string(bytes, values.size() * sizeof(float)));
    writeBytes(folder() / (name + ".json"),
               R"({"size": [2, 2, )" + std::to_string(values.size() / 4) +
                   R"(], "spacing_mm": [1, 1, 2], "type": "float32", "byte_order": "little")" +
                   more + "}");
  }
  // Of the one series, after it was read; a space after each.
  std::string codesOfReading() {
    CtFolder ct = scan();
    if (ct.report().series.size() != 1) return std::to_string(ct.report().series.size()) + " series";
    (void)ct.read(ct.report().series.front().uid, {}, Progress());
    report_ = ct.report();
    return codes(report_.series.front());
  }
};

const std::vector<float> kCt{-1000, 40, 40, 1000, -1000, 50, 60, 70};

TEST_F(FileSeries, ARawFileWithItsSidecarIsOneSeriesWithAReportCard) {
  writeRaw("case", kCt);
  CtFolder ct = scan();
  ASSERT_EQ(ct.report().series.size(), 1u);
  EXPECT_EQ(ct.report().files_seen, 2);
  ASSERT_EQ(ct.report().skipped.size(), 1u);
  EXPECT_EQ(ct.report().skipped.front().reason, "a part of a volume that another file stands for");
  const SeriesReport& series = ct.report().series.front();
  EXPECT_EQ(series.source, "raw");
  EXPECT_EQ(series.verdict, Verdict::pass);
  EXPECT_EQ(series.slices, 2);
  EXPECT_EQ(series.geometry.spacing_mm, Vec3(1, 1, 2));
  const auto volume = ct.read(*ct.bestSeries(), {}, Progress());
  ASSERT_TRUE(volume) << volume.error().sentence();
  EXPECT_EQ(std::vector<std::int16_t>(volume->hu.begin(), volume->hu.end()),
            (std::vector<std::int16_t>{-1000, 40, 40, 1000, -1000, 50, 60, 70}));
  EXPECT_EQ(codes(ct.report().series.front()), "ASSUMED_HU ");
  EXPECT_EQ(ct.report().provenance->source, "raw");
}

TEST_F(FileSeries, ASidecarWhoseRawFileIsNotListedIsListedItself) {
  writeRaw("a", kCt);
  writeRaw("b", kCt);
  fs::remove(folder() / "b.raw");
  fs::create_symlink(folder() / "a.raw", folder() / "b.raw");  // the same file under another name
  const CtFolder ct = scan();
  ASSERT_EQ(ct.report().series.size(), 2u);
  EXPECT_EQ(ct.report().series.back().description, "b.json");
}

TEST_F(FileSeries, TheSidecarItselfMayBeChosen) {
  writeRaw("case", kCt);
  CtFolder ct = scan(folder() / "case.json");
  ASSERT_EQ(ct.report().series.size(), 1u);
  EXPECT_TRUE(ct.read(ct.report().series.front().uid, {}, Progress()));
}

TEST_F(FileSeries, VoxelsBesideTheirHeaderAreListedOnceUnderTheHeader) {
  const char* bytes = reinterpret_cast<const char*>(kCt.data());
  writeBytes(folder() / "case.raw", std::string(bytes, kCt.size() * sizeof(float)));
  writeBytes(folder() / "case.mhd",
             "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
             "TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 0\nElementSpacing = 1 1 2\n"
             "DimSize = 2 2 2\nElementType = MET_FLOAT\nElementDataFile = case.raw\n");
  CtFolder ct = scan();
  ASSERT_EQ(ct.report().series.size(), 1u);
  EXPECT_EQ(ct.report().series.front().description, "case.mhd");
  EXPECT_TRUE(ct.read(ct.report().series.front().uid, {}, Progress()));
}

TEST_F(FileSeries, WhatWasDoneToValuesIsSaidWithTheNumberOfVoxels) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  writeRaw("case", {-1000, 0.25F, 40, 1e6F, -1000, none, none, none, -1000, 30, 30, 30});
  EXPECT_EQ(codesOfReading(), "ASSUMED_HU HU_ROUNDED HU_CLAMPED NOT_NUMBERS ");
  const SeriesReport& series = report_.series.front();
  EXPECT_EQ(series.verdict, Verdict::repaired);
  EXPECT_EQ(find(series, "HU_ROUNDED")->text.substr(0, 8), "1 voxel ");
  EXPECT_EQ(find(series, "HU_CLAMPED")->text.substr(0, 8), "1 voxel ");
  EXPECT_EQ(find(series, "NOT_NUMBERS")->text.substr(0, 8), "3 voxels");
}

TEST_F(FileSeries, ValuesWithoutAirMayBeStoredValues) {
  writeRaw("case", {0, 1040, 1040, 2000, 0, 1050, 1060, 1070});
  EXPECT_EQ(codesOfReading(), "ASSUMED_HU NO_AIR ");
  EXPECT_EQ(report_.series.front().verdict, Verdict::pass);
}

TEST_F(FileSeries, SmallNumbersFromZeroAreALabelMapAndNoCt) {
  writeRaw("case", {0, 1, 1, 5, 0, 1, 2, 2});
  EXPECT_EQ(codesOfReading(), "ASSUMED_HU LABEL_MAP ");
  EXPECT_EQ(report_.series.front().verdict, Verdict::refused);
  EXPECT_EQ(report_.error->code.str(), "LABEL_MAP");
}

TEST_F(FileSeries, OneSliceIsNoVolume) {
  writeRaw("case", {-1000, 40, 40, 1000});
  EXPECT_EQ(codesOfReading(), "ONE_LOCATION ");
}

TEST_F(FileSeries, WhatASidecarLeavesUnsaidIsNoted) {
  writeRaw("case", kCt, "");
  EXPECT_EQ(codesOfReading(), "ASSUMED_HU FILE_NOTE FILE_NOTE ");
  EXPECT_NE(find(report_.series.front(), "FILE_NOTE")->text.find("origin_mm"), std::string::npos);
}

TEST_F(FileSeries, SlicesCountedFromTheOtherEndAreReversedInPlace) {
  writeRaw("case", kCt,
           R"(, "origin_mm": [0, 0, 10], "direction": [1, 0, 0, 0, 1, 0, 0, 0, -1])");
  CtFolder ct = scan();
  const auto volume = ct.read(*ct.bestSeries(), {}, Progress());
  ASSERT_TRUE(volume);
  EXPECT_EQ(codes(ct.report().series.front()), "ASSUMED_HU LEFT_HANDED ");
  EXPECT_EQ(volume->geometry.origin_mm, Vec3(0, 0, 8));
  EXPECT_EQ(volume->at(1, 1, 1), 1000) << "the file's first slice lies at 10 mm";
}

TEST_F(FileSeries, AFileNamedLikeALabelMapIsTheLastToBeChosen) {
  std::vector<float> longer = kCt;
  longer.insert(longer.end(), kCt.begin(), kCt.end());
  writeRaw("aorta_mask", longer);
  writeRaw("patient", kCt);
  const CtFolder ct = scan();
  ASSERT_EQ(ct.report().series.size(), 2u);
  EXPECT_EQ(ct.bestSeries(), "file:patient.raw");
  EXPECT_EQ(codes(ct.report().series.front()), "ASSUMED_HU NAMED_AS_LABELS ");
}

TEST_F(FileSeries, WhatItsFolderIsCalledMakesNoLabelMapOfAFile) {
  fs::create_directories(folder() / "totalsegmentator");
  writeRaw("totalsegmentator/patient", kCt);
  EXPECT_EQ(codesOfReading(), "ASSUMED_HU ");
}

TEST_F(FileSeries, AFileThatCannotBeReadIsListedWithWhatIsWrong) {
  writeBytes(folder() / "case.raw", "1234");
  EXPECT_EQ(codesOfReading(), "NO_SIDECAR ");
  EXPECT_EQ(report_.series.front().verdict, Verdict::refused);
}

}  // namespace
}  // namespace trephine::test
