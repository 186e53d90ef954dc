#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>

#include <array>
#include <vector>

#include "jpeg2000_fixture.h"
#include "series_fixture.h"

namespace trephine::test {

namespace {

// The first frame of a DICOM file, and what its header says.
std::pair<std::vector<std::uint8_t>, Jpeg2000Expectation> frameOf(
    const std::filesystem::path& file) {
  DcmFileFormat dicom;
  EXPECT_TRUE(dicom.loadFile(file.c_str()).good()) << "the file cannot be read";
  DcmDataset& data = *dicom.getDataset();
  DcmElement* element = nullptr;
  EXPECT_TRUE(data.findAndGetElement(DCM_PixelData, element).good());
  auto& pixels = dynamic_cast<DcmPixelData&>(*element);
  E_TransferSyntax syntax = EXS_Unknown;
  const DcmRepresentationParameter* parameter = nullptr;
  pixels.getOriginalRepresentationKey(syntax, parameter);
  DcmPixelSequence* items = nullptr;
  EXPECT_TRUE(pixels.getEncapsulatedRepresentation(syntax, parameter, items).good());
  std::vector<std::uint8_t> bytes;
  for (unsigned long i = 1; i < items->card(); ++i) {  // 0 is the offset table
    DcmPixelItem* item = nullptr;
    Uint8* fragment = nullptr;
    EXPECT_TRUE(items->getItem(item, i).good() && item->getUint8Array(fragment).good());
    bytes.insert(bytes.end(), fragment, fragment + item->getLength());
  }
  const auto value = [&](const DcmTagKey& tag) {
    Uint16 number = 0;
    EXPECT_TRUE(data.findAndGetUint16(tag, number).good());
    return int(number);
  };
  return {bytes,
          {value(DCM_Rows), value(DCM_Columns), value(DCM_BitsAllocated), value(DCM_BitsStored),
           value(DCM_PixelRepresentation) == 1}};
}

}  // namespace

TEST(Jpeg2000, ThePhantomIsReadToThePixel) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const auto folder = data / "hard/derived_phantom_ts";
  const auto [bytes, expected] = frameOf(folder / "j2k_lossless.dcm");
  const Decoded decoded = decode(bytes, expected);

  DcmFileFormat plain;
  ASSERT_TRUE(plain.loadFile((folder / "explicit_le.dcm").c_str()).good());
  const Uint16* words = nullptr;
  unsigned long count = 0;
  ASSERT_TRUE(plain.getDataset()->findAndGetUint16Array(DCM_PixelData, words, &count).good());
  EXPECT_EQ(decoded.values, std::vector<int>(words, words + count));
}

// The range and the sum that pydicom 2.3.1 reads.
TEST(Jpeg2000, RealCtIsReadAsPydicomReadsIt) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const auto summary = [](const std::filesystem::path& file) {
    const auto [bytes, expected] = frameOf(file);
    const std::vector<int> values = decode(bytes, expected).values;
    std::int64_t sum = 0;
    for (const int value : values) sum += value;
    if (values.empty()) return std::array<std::int64_t, 3>{};
    return std::array<std::int64_t, 3>{std::ranges::min(values), std::ranges::max(values), sum};
  };
  using Summary = std::array<std::int64_t, 3>;
  // Coded without a sign, though the header says that it has one.
  EXPECT_EQ(summary(data / "hard/pydicom/J2K_pixelrep_mismatch.dcm"),
            (Summary{-2000, 1896, -172605258}));

  std::vector<std::filesystem::path> slices;
  for (const auto& entry :
       std::filesystem::directory_iterator(data / "abdomen-ct-totalsegmentator/example_ct_dicom")) {
    slices.push_back(entry.path());
  }
  std::ranges::sort(slices);
  ASSERT_EQ(slices.size(), 20u);
  EXPECT_EQ(summary(slices.front()), (Summary{0, 2460, 105356346}));
  EXPECT_EQ(summary(slices.back()), (Summary{0, 2429, 103453060}));
}

}  // namespace trephine::test
