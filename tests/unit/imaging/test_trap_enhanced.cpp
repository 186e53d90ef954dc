// Enhanced multi-frame CT: what a frame says overrides what all share, and frames are slices.
#include "base/memory.h"
#include "imaging/codes.h"
#include "series_fixture.h"

namespace trephine::test {

class TrapEnhanced : public SeriesFixture {
 protected:
  static Image frames(int count) {
    Image image;
    image.frames = count;
    fillPattern(image, 0);
    return image;
  }
  static Vec3 at(double z) { return {-20.0, 10.5, z}; }
  static void put(DcmItem& item, const DcmTagKey& tag, const std::string& value) {
    ASSERT_TRUE(item.putAndInsertString(tag, value.c_str()).good());
  }
  // Slice k of the volume is this frame of the file.
  static void expectFrame(const Volume& volume, int k, int frame, double slope = 1.0,
                          double intercept = -1024.0) {
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 7; ++i) {
        ASSERT_EQ(volume.at(i, j, k), slope * patternValue(i, j, frame) + intercept)
            << "slice " << k << " at " << i << " " << j;
      }
    }
  }
};

TEST_F(TrapEnhanced, FramesInAnyOrderAreSortedByPlace) {
  const int order[] = {3, 0, 5, 1, 4, 2};
  std::vector<Vec3> positions;
  for (const int place : order) positions.push_back(at(100 + 1.25 * place));
  add(makeEnhanced(frames(6), positions));
  const Volume volume = import();
  ASSERT_EQ(volume.geometry.size, (Index3{7, 5, 6}));
  EXPECT_EQ(volume.geometry.origin_mm, at(100));
  EXPECT_EQ(volume.geometry.spacing_mm, Vec3(0.5, 0.75, 1.25));
  for (int frame = 0; frame < 6; ++frame) expectFrame(volume, order[frame], frame);
  EXPECT_EQ(chosen().verdict, Verdict::pass);
}

TEST_F(TrapEnhanced, AFramesOwnRescaleOverridesTheSharedOne) {
  DcmDataset data = makeEnhanced(frames(4), {at(100), at(101), at(102), at(103)});
  DcmItem& own = functionalGroup(data, DCM_PixelValueTransformationSequence, 2);
  put(own, DCM_RescaleSlope, "2");
  put(own, DCM_RescaleIntercept, "-3000");
  put(own, DCM_RescaleType, "HU");
  // What an enhanced image's data set says outside of the groups is nothing.
  add(data);
  const Volume volume = import();
  for (const int frame : {0, 1, 3}) expectFrame(volume, frame, frame);
  expectFrame(volume, 2, 2, 2.0, -3000.0);
}

TEST_F(TrapEnhanced, AFramesOwnPositionOverridesTheSharedOne) {
  DcmDataset data = makeEnhanced(frames(4), {at(100), at(101), at(102), at(103)});
  put(functionalGroup(data, DCM_PlanePositionSequence, -1), DCM_ImagePositionPatient,
      positionText(at(500)));
  add(data);
  const Volume volume = import();
  EXPECT_EQ(volume.geometry.origin_mm, at(100));
  for (int frame = 0; frame < 4; ++frame) expectFrame(volume, frame, frame);
}

TEST_F(TrapEnhanced, TwoOrientationsInOneFileAreTwoStacks) {
  std::vector<Vec3> positions;
  for (int n = 0; n < 5; ++n) positions.push_back(at(100 + n));
  for (int n = 0; n < 4; ++n) positions.push_back({-20.0, 10.5 + n, 100.0});
  DcmDataset data = makeEnhanced(frames(9), positions);
  for (int frame = 5; frame < 9; ++frame) {
    put(functionalGroup(data, DCM_PlaneOrientationSequence, frame), DCM_ImageOrientationPatient,
        "1\\0\\0\\0\\0\\-1");
  }
  add(data);
  CtFolder ct = scan();
  ASSERT_EQ(ct.report().series.size(), 2u);
  const auto axial = ct.read("1.2.3.4", {}, Progress());
  ASSERT_TRUE(axial.ok()) << axial.error().sentence();
  ASSERT_EQ(axial->geometry.size[2], 5);
  for (int frame = 0; frame < 5; ++frame) expectFrame(*axial, frame, frame);
  const auto coronal = ct.read("1.2.3.4#2", {}, Progress());
  ASSERT_TRUE(coronal.ok()) << coronal.error().sentence();
  ASSERT_EQ(coronal->geometry.size[2], 4);
  for (int k = 0; k < 4; ++k) expectFrame(*coronal, k, 5 + k);
  EXPECT_EQ(coronal->geometry.direction[2], Vec3(0, 1, 0));
}

TEST_F(TrapEnhanced, TwoStacksAsideOfEachOtherAreNotOneVolume) {
  std::vector<Vec3> positions;
  for (int n = 0; n < 4; ++n) positions.push_back(at(100 + n));
  for (int n = 0; n < 4; ++n) positions.push_back(at(180 + n));
  add(makeEnhanced(frames(8), positions));
  CtFolder ct = scan();
  for (const SeriesReport& series : ImportReport(ct.report()).series) {
    const auto volume = ct.read(series.uid, {}, Progress());
    EXPECT_FALSE(volume.ok() && volume->geometry.size[2] > 4);
  }
}

TEST_F(TrapEnhanced, PhasesByTemporalPositionIndex) {
  std::vector<Vec3> positions;
  for (int n = 0; n < 8; ++n) positions.push_back(at(100 + n / 2));
  DcmDataset data = makeEnhanced(frames(8), positions);
  for (int n = 0; n < 8; ++n) {
    DcmItem& content = functionalGroup(data, DCM_FrameContentSequence, n);
    ASSERT_TRUE(
        content.putAndInsertUint32(DCM_TemporalPositionIndex, Uint32(n % 2 ? 1 : 2)).good());
  }
  add(data);
  expectRefused("PHASES");
  EXPECT_EQ(report_.series.front().phases, 2);
  for (const int phase : {1, 2}) {
    const Volume volume = import({{code::kPhases, std::to_string(phase)}});
    ASSERT_EQ(volume.geometry.size[2], 4);
    for (int k = 0; k < 4; ++k) expectFrame(volume, k, 2 * k + (phase == 1 ? 1 : 0));
  }
}

TEST_F(TrapEnhanced, FramesWithoutTheirGroupsAreNotGuessed) {
  add(makeEnhanced(frames(6), {at(100), at(101), at(102), at(103)}));
  const Finding finding = expectRefused("NO_GEOMETRY");
  EXPECT_EQ(finding.slices, (std::vector<std::string>{"slice 5", "slice 6"}));
}

TEST_F(TrapEnhanced, AFrameWithoutARescaleThatOthersHaveIsNotTakenSilently) {
  DcmDataset data = makeEnhanced(frames(4), {at(100), at(101), at(102), at(103)});
  DcmItem* shared = nullptr;
  ASSERT_TRUE(data.findAndGetSequenceItem(DCM_SharedFunctionalGroupsSequence, shared).good());
  ASSERT_TRUE(shared->findAndDeleteElement(DCM_PixelValueTransformationSequence).good());
  for (const int frame : {0, 1, 3}) {
    DcmItem& own = functionalGroup(data, DCM_PixelValueTransformationSequence, frame);
    put(own, DCM_RescaleSlope, "1");
    put(own, DCM_RescaleIntercept, "-1024");
  }
  add(data);
  expectRefused("BAD_RESCALE");
}

TEST_F(TrapEnhanced, ASeriesOfSeveralEnhancedFilesIsOneStack) {
  Image first = frames(3), second = frames(3);
  second.instance = 2;
  fillPattern(second, 3);
  add(makeEnhanced(second, {at(103), at(104), at(105)}));
  add(makeEnhanced(first, {at(100), at(101), at(102)}));
  const Volume volume = import();
  ASSERT_EQ(volume.geometry.size[2], 6);
  for (int k = 0; k < 6; ++k) expectFrame(volume, k, k);
}

TEST_F(TrapEnhanced, EveryUncompressedSyntaxGivesEveryFrame) {
  for (const E_TransferSyntax syntax :
       {EXS_LittleEndianImplicit, EXS_BigEndianExplicit, EXS_DeflatedLittleEndianExplicit}) {
    for (const int bits : {8, 12}) {
      SCOPED_TRACE(std::string(DcmXfer(syntax).getXferName()) + std::to_string(bits));
      std::filesystem::remove_all(folder());
      Image image;
      image.frames = 5;  // of 35 pixels: at 8 bits frames start at odd bytes
      image.bits_stored = bits;
      image.high_bit = bits - 1;
      image.bits_allocated = bits == 8 ? 8 : 16;
      fillPattern(image, 0);
      add(makeEnhanced(image, {at(104), at(103), at(102), at(101), at(100)}), {syntax});
      const Volume volume = import();
      for (int k = 0; k < 5; ++k) {
        for (int n = 0; n < 35; ++n) {
          ASSERT_EQ(volume.hu[std::size_t(k * 35 + n)],
                    patternValue(n % 7, n / 7, 4 - k, bits) - 1024);
        }
      }
    }
  }
}

TEST_F(TrapEnhanced, ACutFileKeepsTheFramesThatAreWhole) {
  add(makeEnhanced(frames(6), {at(100), at(101), at(102), at(103), at(104), at(105)}));
  const auto file = std::filesystem::directory_iterator(folder())->path();
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 35 * 2 - 10);
  expectRefused("MISSING_SLICES");
  const Volume volume = import({{code::kMissingSlices, "part"}});
  ASSERT_EQ(volume.geometry.size[2], 4);
  for (int k = 0; k < 4; ++k) expectFrame(volume, k, k);
}

TEST_F(TrapEnhanced, ACutFileKeepsTheCompressedFramesThatAreWhole) {
  for (const int fragments : {1, 3}) {
    for (const int cut : {9, 60}) {  // in the mark behind the last frame, or in that frame
      SCOPED_TRACE(std::to_string(fragments) + " fragments, without " + std::to_string(cut));
      std::filesystem::remove_all(folder());
      Packing packing{EXS_JPEGLSLossless};
      packing.fragments = fragments;
      add(makeEnhanced(frames(5), {at(100), at(101), at(102), at(103), at(104)}), packing);
      const auto file = std::filesystem::directory_iterator(folder())->path();
      std::filesystem::resize_file(file, std::filesystem::file_size(file) - std::uintmax_t(cut));
      EXPECT_EQ(expectRefused("MISSING_SLICES").slices, std::vector<std::string>{"104.00 mm"});
      const Volume volume = import({{code::kMissingSlices, "part"}});
      ASSERT_EQ(volume.geometry.size[2], 4);
      for (int k = 0; k < 4; ++k) expectFrame(volume, k, k);
    }
  }
}

TEST_F(TrapEnhanced, AClaimOfAHundredThousandFramesCostsLittle) {
  DcmDataset data = makeEnhanced(frames(4), {at(100), at(101), at(102), at(103)});
  put(data, DCM_NumberOfFrames, "100000");
  add(data);
  const double before_mb = peakResidentMb();
  expectRefused("SIZE_MISMATCH");
  EXPECT_LT(peakResidentMb(), before_mb + 60.0);
}

}  // namespace trephine::test
