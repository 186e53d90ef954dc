#include "bench/import/scanner_series.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>
#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpls/djdecode.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>

#include "bench/import/noisy_ct.h"
#include "imaging/dicom/jpeg2000.h"
#include "imaging/importer.h"
#include "support.h"

namespace trephine::bench {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

const Progress kQuiet;

Volume noisyCt(const Index3& size) {
  Result<Volume> volume = makeNoisyCt(size, kQuiet);
  EXPECT_TRUE(volume) << volume.error().sentence();
  return *std::move(volume);
}

std::vector<fs::path> filesOf(const fs::path& folder) {
  std::vector<fs::path> files(fs::directory_iterator(folder), fs::directory_iterator{});
  std::sort(files.begin(), files.end());
  return files;
}

// The stored words of a slice, decoded by DCMTK or, for JPEG 2000, by OpenJPEG.
std::vector<Uint16> wordsOf(DcmDataset& data, int columns, int rows) {
  std::vector<Uint16> words(std::size_t(columns) * std::size_t(rows));
  if (data.getOriginalXfer() == EXS_JPEG2000LosslessOnly) {
    DcmElement* element = nullptr;
    DcmPixelSequence* sequence = nullptr;
    DcmPixelItem* item = nullptr;
    Uint8* bytes = nullptr;
    EXPECT_TRUE(data.findAndGetElement(DCM_PixelData, element).good());
    auto& pixels = dynamic_cast<DcmPixelData&>(*element);
    EXPECT_TRUE(
        pixels.getEncapsulatedRepresentation(data.getOriginalXfer(), nullptr, sequence).good());
    EXPECT_EQ(sequence->card(), 2u) << "an offset table and one fragment";
    EXPECT_TRUE(sequence->getItem(item, 1).good());
    EXPECT_TRUE(item->getUint8Array(bytes).good());
    const Status decoded =
        decodeJpeg2000({bytes, item->getLength()}, {rows, columns, 16, 12, false},
                       reinterpret_cast<std::int16_t*>(words.data()));
    EXPECT_TRUE(decoded) << decoded.error().sentence();
    return words;
  }
  EXPECT_TRUE(data.chooseRepresentation(EXS_LittleEndianExplicit, nullptr).good());
  const Uint16* decoded = nullptr;
  unsigned long count = 0;
  EXPECT_TRUE(data.findAndGetUint16Array(DCM_PixelData, decoded, &count).good());
  EXPECT_EQ(count, words.size());
  if (count == words.size()) std::copy(decoded, decoded + count, words.begin());
  return words;
}

double numberOf(DcmDataset& data, const DcmTagKey& tag, unsigned long index = 0) {
  OFString text;
  EXPECT_TRUE(data.findAndGetOFString(tag, text, index).good()) << tag.toString();
  return std::stod(text.c_str());
}

std::string uidOf(DcmDataset& data, const DcmTagKey& tag) {
  OFString text;
  EXPECT_TRUE(data.findAndGetOFString(tag, text).good());
  return text.c_str();
}

TEST(NoisyCt, HasTheSameBitsEverywhere) {
  EXPECT_EQ(volumeSha256(noisyCt({33, 24, 7})),
            "b9471b83a5bd49bac3715ee70312ea9e476185a61115ee27b05e452403685a59");
}

TEST(NoisyCt, HasTheNoiseOfACtInTheBrain) {
  const Volume volume = noisyCt({256, 256, 240});
  const auto medianOf = [](std::vector<double>& values) {
    std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
  };
  // Differences with the next slice: white across slices. Medians, since edges are no noise.
  std::vector<double> across, along;
  for (int k = 140; k < 150; ++k) {
    for (int j = 80; j < 170; ++j) {
      for (int i = 80; i < 170; ++i) {
        across.push_back(std::abs(volume.at(i, j, k) - volume.at(i, j, k + 1)));
        along.push_back(std::abs(volume.at(i, j, k) - volume.at(i + 1, j, k)));
      }
    }
  }
  const double sd = medianOf(across) / 0.6745 / std::sqrt(2.0);
  EXPECT_NEAR(sd, 15.0, 1.0);
  const double correlation = 1.0 - std::pow(medianOf(along) / medianOf(across), 2.0);
  EXPECT_NEAR(correlation, 0.44, 0.06);
}

TEST(NoisyCt, FillsTheRangeOfAScannerAndNoMore) {
  const Volume volume = noisyCt({128, 128, 100});
  const auto [low, high] = std::minmax_element(volume.hu.begin(), volume.hu.end());
  EXPECT_EQ(*low, -1024) << "air with noise is cut off there";
  EXPECT_GT(*high, 1000) << "bone";
  EXPECT_LE(*high, 3071);
  EXPECT_NEAR(volume.geometry.spacing_mm.x * 128, 230.0, 1e-9);
}

TEST(NoisyCt, RefusesEdgesThatItCannotMake) {
  for (const Index3 size :
       {Index3{1, 8, 8}, Index3{8, 2049, 8}, Index3{8, 8, 0}, Index3{1024, 1024, 257}}) {
    const Result<Volume> volume = makeNoisyCt(size, kQuiet);
    ASSERT_FALSE(volume);
    EXPECT_EQ(volume.error().code.str(), "BAD_ARGUMENT");
  }
}

class EverySyntax : public ::testing::TestWithParam<SeriesSyntax> {
 protected:
  static void SetUpTestSuite() {
    DJDecoderRegistration::registerCodecs();
    DJLSDecoderRegistration::registerCodecs();
    DcmRLEDecoderRegistration::registerCodecs();
  }
};

TEST_P(EverySyntax, HoldsTheVolumesVoxelsInTheTransferSyntaxOfItsName) {
  static const std::map<SeriesSyntax, E_TransferSyntax> expected{
      {SeriesSyntax::int16, EXS_LittleEndianExplicit},
      {SeriesSyntax::u12, EXS_LittleEndianExplicit},
      {SeriesSyntax::big_endian, EXS_BigEndianExplicit},
      {SeriesSyntax::deflated, EXS_DeflatedLittleEndianExplicit},
      {SeriesSyntax::rle, EXS_RLELossless},
      {SeriesSyntax::jpegls, EXS_JPEGLSLossless},
      {SeriesSyntax::jpegll, EXS_JPEGProcess14SV1},
      {SeriesSyntax::j2k, EXS_JPEG2000LosslessOnly}};
  const TemporaryFolder folder;
  const Volume volume = noisyCt({60, 44, 5});
  ASSERT_TRUE(writeSeries(volume, GetParam(), folder / "series", kQuiet));
  const std::vector<fs::path> files = filesOf(folder / "series");
  ASSERT_EQ(files.size(), 5u);
  std::set<std::string> instances, series;
  for (int k = 0; k < 5; ++k) {
    SCOPED_TRACE(k);
    DcmFileFormat format;
    ASSERT_TRUE(format.loadFile(OFFilename(files[std::size_t(k)].c_str())).good());
    DcmDataset& data = *format.getDataset();
    ASSERT_EQ(data.getOriginalXfer(), expected.at(GetParam()));
    EXPECT_NEAR(numberOf(data, DCM_ImagePositionPatient, 2),
                volume.geometry.toPatient_mm(Vec3(0, 0, k)).z, 1e-6);
    EXPECT_NEAR(numberOf(data, DCM_PixelSpacing, 0), volume.geometry.spacing_mm.y, 1e-6);
    EXPECT_NEAR(numberOf(data, DCM_PixelSpacing, 1), volume.geometry.spacing_mm.x, 1e-6);
    instances.insert(uidOf(data, DCM_SOPInstanceUID));
    series.insert(uidOf(data, DCM_SeriesInstanceUID));

    const bool int16 = GetParam() == SeriesSyntax::int16;
    EXPECT_EQ(numberOf(data, DCM_BitsStored), int16 ? 16 : 12);
    EXPECT_EQ(numberOf(data, DCM_PixelRepresentation), int16 ? 1 : 0);
    const double slope = numberOf(data, DCM_RescaleSlope);
    const double intercept = numberOf(data, DCM_RescaleIntercept);
    const std::vector<Uint16> words = wordsOf(data, 60, 44);
    int wrong = 0;
    for (std::size_t n = 0; n < words.size(); ++n) {
      const int stored = int16 ? int(Sint16(words[n])) : int(words[n]);
      wrong += slope * stored + intercept != volume.hu[std::size_t(k) * words.size() + n];
    }
    EXPECT_EQ(wrong, 0);
  }
  EXPECT_EQ(instances.size(), 5u);
  EXPECT_EQ(series.size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(Series, EverySyntax,
                         ::testing::Values(SeriesSyntax::int16, SeriesSyntax::u12,
                                           SeriesSyntax::big_endian, SeriesSyntax::deflated,
                                           SeriesSyntax::rle, SeriesSyntax::jpegls,
                                           SeriesSyntax::jpegll, SeriesSyntax::j2k),
                         [](const auto& tested) {
                           std::string name = nameOf(kSeriesSyntaxes, tested.param);
                           std::erase(name, '-');
                           return name;
                         });

TEST(ScannerSeries, IsReadByTheImporterAsItWasMade) {
  const TemporaryFolder folder;
  const Volume volume = noisyCt({40, 32, 10});
  for (const auto& [name, syntax] : kSeriesSyntaxes) {
    SCOPED_TRACE(name);
    const fs::path path = folder / std::string(name);
    ASSERT_TRUE(writeSeries(volume, syntax, path, kQuiet));
    Result<CtFolder> read = CtFolder::scan(path, kQuiet);
    ASSERT_TRUE(read);
    ASSERT_TRUE(read->bestSeries());
    const Result<Volume> again = read->read(*read->bestSeries(), {}, kQuiet);
    ASSERT_TRUE(again) << again.error().sentence();
    EXPECT_EQ(again->hu, volume.hu);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(again->geometry.spacing_mm[axis], volume.geometry.spacing_mm[axis], 1e-6);
      EXPECT_NEAR(again->geometry.origin_mm[axis], volume.geometry.origin_mm[axis], 1e-6);
    }
    EXPECT_EQ(read->report().series.front().verdict, Verdict::pass);
  }
}

TEST(ScannerSeries, HasTheLongHeadersOfAScanner) {
  const TemporaryFolder folder;
  ASSERT_TRUE(writeSeries(noisyCt({8, 8, 2}), SeriesSyntax::int16, folder.path(), kQuiet));
  DcmFileFormat format;
  ASSERT_TRUE(format.loadFile(OFFilename(filesOf(folder.path()).front().c_str())).good());
  DcmDataset& data = *format.getDataset();
  int own = 0, sequences = 0;
  for (unsigned long n = 0; n < data.card(); ++n) {
    const DcmElement& element = *data.getElement(n);
    own += element.getGTag() % 2 == 1;
    sequences += element.ident() == EVR_SQ;
  }
  EXPECT_GE(data.card(), 100u);
  EXPECT_GE(own, 20);
  EXPECT_EQ(sequences, 3);
}

TEST(ManySeries, AreAsManyAsAsked) {
  const TemporaryFolder folder;
  ASSERT_TRUE(writeManySeries(3, 10, folder / "many", kQuiet));
  EXPECT_EQ(filesOf(folder / "many").size(), 30u);
  const Result<CtFolder> read = CtFolder::scan(folder / "many", kQuiet);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->report().series.size(), 3u);
  for (const SeriesReport& series : read->report().series) {
    EXPECT_EQ(series.verdict, Verdict::pass);
    EXPECT_EQ(series.geometry.size, (Index3{64, 64, 10}));
  }
}

TEST(ScannerSeries, SaysThatItCannotWrite) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  const Status written =
      writeSeries(noisyCt({8, 8, 2}), SeriesSyntax::int16, folder / "file", kQuiet);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code.str(), "CANNOT_WRITE");
}

TEST(ScannerSeries, StopsWhenItIsCancelled) {
  const TemporaryFolder folder;
  const Volume volume = noisyCt({8, 8, 200});
  Progress cancelled;
  cancelled.cancel();
  const Status written = writeSeries(volume, SeriesSyntax::int16, folder.path(), cancelled);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code.str(), "CANCELLED");
  const Result<Volume> made = makeNoisyCt({8, 8, 200}, cancelled);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code.str(), "CANCELLED");
}

TEST(ScannerSeries, AreWrittenByNameWithWhatTheyHold) {
  const TemporaryFolder folder;
  ImportSeries series;
  series.names = {"rle", "int16"};
  series.size = {24, 20, 3};
  series.scan_series = series.scan_slices = 2;
  const auto known = writeScannerSeries(series, folder.path(), kQuiet);
  ASSERT_TRUE(known) << known.error().sentence();
  ASSERT_EQ(known->size(), 2u);
  EXPECT_EQ((*known)[0].sha256, volumeSha256(noisyCt(series.size)));
  EXPECT_EQ(filesOf(folder / "rle").size(), 3u);
  EXPECT_EQ(filesOf(folder / "int16").size(), 3u);
  EXPECT_EQ(filesOf(folder / "scan").size(), 4u);
}

}  // namespace
}  // namespace trephine::bench
