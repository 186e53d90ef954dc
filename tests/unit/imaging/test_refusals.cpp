#include "base/memory.h"
#include "imaging/codes.h"
#include "series_fixture.h"

namespace trephine::test {

using Refusal = SeriesFixture;
namespace fs = std::filesystem;

TEST_F(Refusal, AMissingSliceIsNamedInMillimetres) {
  write(rampVolume());
  fs::remove(slice(3));
  const Finding finding = expectRefused("MISSING_SLICES");
  EXPECT_EQ(finding.slices, std::vector<std::string>{"102.50 mm"});
  ASSERT_TRUE(report_.error.has_value());
  EXPECT_EQ(report_.error->code.str(), "ALL_REFUSED");
}

TEST_F(Refusal, ATruncatedSliceIsAMissingSliceAndTheOthersAreStillListed) {
  write(rampVolume());
  fs::resize_file(slice(2), fs::file_size(slice(2)) - 8);
  const Finding finding = expectRefused("MISSING_SLICES");
  EXPECT_EQ(finding.slices, std::vector<std::string>{"101.25 mm"});
  EXPECT_NE(finding.text.find("slice 2 (its pixels are cut short)"), std::string::npos)
      << finding.text;
  EXPECT_EQ(report_.series.front().geometry.size, (Index3{7, 5, 6}));
}

TEST_F(Refusal, ASliceCutInItsHeaderIsAMissingSlice) {
  write(rampVolume());
  const std::string bytes = readBytes(slice(2));
  // After the series is named, before the position is.
  const std::string position("\x20\x00\x32\x00", 4);
  writeBytes(slice(2), bytes.substr(0, bytes.find(position)));
  EXPECT_EQ(expectRefused("MISSING_SLICES").slices.size(), 1u);
}

TEST_F(Refusal, TwoSlicesAtOnePlace) {
  write(rampVolume());
  edit(slice(3),
       [](DcmDataset& data) { put(data, DCM_ImagePositionPatient, "-20\\10.5\\101.25"); });
  expectRefused("DUPLICATE_POSITIONS");
}

TEST_F(Refusal, TwoScansOfOnePlaceAreAChoiceWhereSomethingTellsThemApart) {
  const Volume volume = rampVolume();
  write(volume);
  const auto second = [&](int n) { return folder() / ("phase2-" + std::to_string(n)); };
  for (int n = 1; n <= 6; ++n) {
    fs::copy_file(slice(n), second(n));
    edit(second(n), [&](DcmDataset& data) {
      put(data, DCM_SOPInstanceUID, "1.2.3." + std::to_string(n));
      put(data, DCM_RescaleIntercept, "-1000");
    });
  }
  // Their instance numbers are the same.
  EXPECT_EQ(expectRefused("DUPLICATE_POSITIONS").slices.size(), 6u);
  EXPECT_TRUE(report_.series.front().choices.empty());
  for (int n = 1; n <= 6; ++n) {
    edit(slice(n), [](DcmDataset& data) { put(data, DCM_AcquisitionNumber, "1"); });
    edit(second(n), [](DcmDataset& data) { put(data, DCM_AcquisitionNumber, "2"); });
  }
  EXPECT_NE(expectRefused("PHASES").text.find("2 phases"), std::string::npos);
  EXPECT_EQ(report_.series.front().phases, 2);
}

TEST_F(Refusal, UnevenSpacing) {
  write(rampVolume());
  edit(slice(6), [](DcmDataset& data) { put(data, DCM_ImagePositionPatient, "-20\\10.5\\106.8"); });
  expectRefused("UNEVEN_SPACING");
}

TEST_F(Refusal, SlicesThatLieFartherAsideThanTheyAreWide) {
  write(rampVolume());
  for (int n = 1; n <= 6; ++n) {
    edit(slice(n), [&](DcmDataset& data) {
      put(data, DCM_ImagePositionPatient,
          "-20\\" + std::to_string(10 + n) + "\\" + std::to_string(100 + n * 2));
    });
  }
  expectRefused("GANTRY_TILT");
  EXPECT_NEAR(report_.series.front().tilt_deg, 26.565, 0.001);
}

TEST_F(Refusal, AnOrientationThatIsNotOrthonormal) {
  write(rampVolume());
  editAll([](DcmDataset& data) { put(data, DCM_ImageOrientationPatient, "1\\0\\0\\0.5\\0.8\\0"); });
  expectRefused("NOT_ORTHONORMAL");
}

TEST_F(Refusal, ASliceWithoutPosition) {
  write(rampVolume());
  edit(slice(4), [](DcmDataset& data) { data.findAndDeleteElement(DCM_ImagePositionPatient); });
  EXPECT_EQ(expectRefused("NO_GEOMETRY").slices, std::vector<std::string>{"slice 4"});
}

TEST_F(Refusal, ZeroPixelSpacing) {
  write(rampVolume());
  editAll([](DcmDataset& data) { put(data, DCM_PixelSpacing, "0\\0.5"); });
  expectRefused("NO_GEOMETRY");
}

TEST_F(Refusal, ASingleSlice) {
  write(rampVolume({7, 5, 1}));
  expectRefused("ONE_LOCATION");
}

TEST_F(Refusal, ColourPixels) {
  write(rampVolume());
  editAll([](DcmDataset& data) {
    put(data, DCM_PhotometricInterpretation, "RGB");
    data.putAndInsertUint16(DCM_SamplesPerPixel, 3);
  });
  expectRefused("COLOUR");
}

TEST_F(Refusal, ImagesThatAreNotCt) {
  write(rampVolume());
  editAll([](DcmDataset& data) {
    put(data, DCM_SOPClassUID, UID_MRImageStorage);
    put(data, DCM_Modality, "MR");
  });
  expectRefused("NOT_CT");
  EXPECT_EQ(report_.error->code.str(), "NO_CT");
}

TEST_F(Refusal, SecondaryCapturesThatSayTheyAreCt) {
  write(rampVolume());
  editAll([](DcmDataset& data) { put(data, DCM_SOPClassUID, UID_SecondaryCaptureImageStorage); });
  expectRefused("SECONDARY_CAPTURE");
}

TEST_F(Refusal, ObjectsWithoutPixels) {
  write(rampVolume());
  editAll([](DcmDataset& data) {
    put(data, DCM_SOPClassUID, UID_BasicTextSRStorage);
    put(data, DCM_Modality, "SR");
    data.findAndDeleteElement(DCM_PixelData);
  });
  expectRefused("NOT_AN_IMAGE_SERIES");
}

TEST_F(Refusal, FramesThatDoNotSayWhereTheyLie) {
  write(rampVolume({7, 5, 1}));
  editAll([](DcmDataset& data) {
    const std::vector<Uint16> frames(7 * 5 * 4, 1024);
    data.putAndInsertUint16Array(DCM_PixelData, frames.data(), frames.size());
    put(data, DCM_NumberOfFrames, "4");
  });
  expectRefused("MULTIFRAME");
}

TEST_F(Refusal, ValuesThatAreNotHu) {
  write(rampVolume());
  editAll([](DcmDataset& data) { put(data, DCM_RescaleType, "MGML"); });
  expectRefused("NOT_HU");
}

TEST_F(Refusal, ARescaleThatIsNoNumber) {
  write(rampVolume());
  editAll([](DcmDataset& data) { put(data, DCM_RescaleSlope, "1,0"); });
  expectRefused("BAD_RESCALE");
}

TEST_F(Refusal, BitsThatCannotBe) {
  for (const auto& [stored, high] : {std::pair(0, 11), {17, 16}, {12, 3}, {12, 16}}) {
    write(rampVolume());
    editAll([&, bits = stored, top = high](DcmDataset& data) {
      data.putAndInsertUint16(DCM_BitsStored, Uint16(bits));
      data.putAndInsertUint16(DCM_HighBit, Uint16(top));
    });
    expectRefused("PIXEL_FORMAT");
  }
}

TEST_F(Refusal, PixelsOnceCompressedWithLossAwaitConsent) {
  write(rampVolume());
  editAll([](DcmDataset& data) { put(data, DCM_LossyImageCompression, "01"); });
  expectRefused("LOSSY_SOURCE");
  EXPECT_TRUE(report_.series.front().lossy);
}

TEST_F(Refusal, PixelsThatDoNotFitRowsAndColumns) {
  write(rampVolume());
  edit(slice(1), [](DcmDataset& data) {
    const std::vector<Uint16> few(20, 0);
    data.putAndInsertUint16Array(DCM_PixelData, few.data(), few.size());
  });
  EXPECT_EQ(expectRefused("SIZE_MISMATCH").slices, std::vector<std::string>{"slice 1"});
}

TEST_F(Refusal, MorePixelsThanRowsAndColumnsSay) {
  write(rampVolume());
  editAll([](DcmDataset& data) { data.putAndInsertUint16(DCM_Rows, 4); });
  expectRefused("SIZE_MISMATCH");
}

TEST_F(Refusal, AHeaderOfFourGigavoxelsWithFewPixelsAllocatesNothing) {
  write(rampVolume({16, 16, 4}));
  editAll([](DcmDataset& data) {
    data.putAndInsertUint16(DCM_Rows, 65535);
    data.putAndInsertUint16(DCM_Columns, 65535);
  });
  const double before_mb = peakResidentMb();
  expectRefused("SIZE_MISMATCH");
  EXPECT_LT(peakResidentMb(), before_mb + 200.0);
}

TEST_F(Refusal, ACompressedTransferSyntaxIsNamed) {
  write(rampVolume());
  // The bytes need not be JPEG 2000: the syntax is refused before they are looked at.
  for (int n = 1; n <= 6; ++n) {
    std::string bytes = readBytes(slice(n));
    const std::string explicit_little("1.2.840.10008.1.2.1\0", 20);
    const std::size_t at = bytes.find(explicit_little);
    ASSERT_NE(at, std::string::npos);
    bytes.replace(at, 20, std::string("1.2.840.10008.1.2.9\0", 20));
    writeBytes(slice(n), bytes);
  }
  const Finding finding = expectRefused("UNSUPPORTED_TRANSFER_SYNTAX");
  EXPECT_NE(finding.text.find("1.2.840.10008.1.2.9"), std::string::npos) << finding.text;
}

TEST_F(Refusal, WhatNoAnswerCanSaveIsNotAskedAbout) {
  write(rampVolume());
  editAll([](DcmDataset& data) { put(data, DCM_LossyImageCompression, "01"); });
  expectRefused("LOSSY_SOURCE");
  EXPECT_EQ(report_.series.front().choices.size(), 1u);
  editAll([](DcmDataset& data) { put(data, DCM_PixelSpacing, "0\\0"); });
  EXPECT_EQ(scan().report().series.front().verdict, Verdict::refused);
  EXPECT_TRUE(scan().report().series.front().choices.empty());
  EXPECT_FALSE(scan().bestSeries({{code::kLossySource, "accept"}}));
}

TEST_F(Refusal, OfAWholeSeriesWhoseOrientationIsNone) {
  for (const char* orientation : {"0\\0\\0\\0\\0\\0", "1\\0\\0\\1\\0\\0", "1\\0\\0\\0.01\\1\\0"}) {
    write(rampVolume());
    editAll([&](DcmDataset& data) {
      put(data, DCM_ImageOrientationPatient, orientation);
      put(data, DCM_SliceLocation, "3");
      put(data, DCM_SpacingBetweenSlices, "3");
    });
    expectRefused("NOT_ORTHONORMAL");
  }
}

TEST_F(Refusal, OfValuesThatAreScaledBeyondCt) {
  for (const char* slope : {"-1e9", "1e30"}) {
    write(rampVolume());
    edit(slice(3), [&](DcmDataset& data) { put(data, DCM_RescaleSlope, slope); });
    expectRefused("BAD_RESCALE");
  }
}

}  // namespace trephine::test
