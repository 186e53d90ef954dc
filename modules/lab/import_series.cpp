#include "lab/import_series.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcrleerg.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmjpeg/djencode.h>
#include <dcmtk/dcmjpeg/djrplol.h>
#include <dcmtk/dcmjpls/djencode.h>
#include <dcmtk/dcmjpls/djrparam.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <mutex>
#include <vector>

#include "base/file.h"
#include "imaging/workers.h"
#include "lab/j2k_encoder.h"
#include "volume/phantom.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr Vec3 kExtent_mm{230.0, 230.0, 180.0};
constexpr double kNoiseHu = 15.0;
constexpr int kLowestHu = -1024, kHighestHu = 3071;

// splitmix64's finaliser.
std::uint64_t hashOf(std::uint64_t n) {
  std::uint64_t h = (n + 1) * 0x9e3779b97f4a7c15;
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9;
  h = (h ^ (h >> 27)) * 0x94d049bb133111eb;
  return h ^ (h >> 31);
}

// The sum of a hash's eight bytes about its mean: variance 8 * (256^2 - 1) / 12 = 43690.
int whiteNoise(std::uint64_t n) {
  const std::uint64_t h = hashOf(n);
  int sum = -1020;
  for (int byte = 0; byte < 8; ++byte) sum += int(h >> (8 * byte) & 0xff);
  return sum;
}

GridGeometry geometryOf(const Index3& size) {
  GridGeometry g;
  g.size = size;
  for (int axis = 0; axis < 3; ++axis) {
    g.spacing_mm[axis] = kExtent_mm[axis] / size[axis];
    g.origin_mm[axis] = -0.5 * (size[axis] - 1) * g.spacing_mm[axis];
  }
  return g;
}

// Every voxel of `coarse` becomes eight, interpolated linearly: weights 3/4 and 1/4 on each axis.
// Noise, correlated by 1-4-1 along rows and columns, is added.
class Refinement {
 public:
  Refinement(const Volume& coarse, Volume& fine) : coarse_(coarse), fine_(fine) {}

  void slice(int k) const {
    const Index3& size = fine_.geometry.size;
    const std::size_t nx = std::size_t(size[0]), ny = std::size_t(size[1]);
    // One more pixel on every side, which the smoothing takes away again.
    std::vector<int> noise((nx + 2) * (ny + 2)), rows(nx * (ny + 2));
    for (std::size_t n = 0; n < noise.size(); ++n) {
      noise[n] = whiteNoise(std::uint64_t(k) * noise.size() + n);
    }
    for (std::size_t j = 0; j < ny + 2; ++j) {
      for (std::size_t i = 0; i < nx; ++i) {
        const int* at = &noise[j * (nx + 2) + i];
        rows[j * nx + i] = at[0] + 4 * at[1] + at[2];
      }
    }
    static const double scale = kNoiseHu / (18.0 * std::sqrt(43690.0));  // 18 = 1 + 16 + 1
    std::int16_t* out = &fine_.hu[fine_.geometry.indexOf(0, 0, k)];
    for (std::size_t j = 0; j < ny; ++j) {
      for (std::size_t i = 0; i < nx; ++i) {
        const int* at = &rows[j * nx + i];
        const int smooth = at[0] + 4 * at[nx] + at[2 * nx];
        const double hu = interpolated(int(i), int(j), k) / 64.0 + smooth * scale;
        *out++ = std::int16_t(
            std::floor(std::clamp(hu, double(kLowestHu), double(kHighestHu)) + 0.5));
      }
    }
  }

 private:
  int interpolated(int i, int j, int k) const {
    const Index3& n = coarse_.geometry.size;
    const auto far = [](int at, int edge) {
      return std::clamp(at / 2 + (at % 2 == 0 ? -1 : 1), 0, edge - 1);
    };
    const int is[2] = {i / 2, far(i, n[0])}, js[2] = {j / 2, far(j, n[1])},
              ks[2] = {k / 2, far(k, n[2])};
    int sum = 0;
    for (int c = 0; c < 8; ++c) {
      const int weight = (c & 1 ? 1 : 3) * (c & 2 ? 1 : 3) * (c & 4 ? 1 : 3);
      sum += weight * coarse_.at(is[c & 1], js[c >> 1 & 1], ks[c >> 2]);
    }
    return sum;
  }

  const Volume& coarse_;
  Volume& fine_;
};

struct Element {
  Uint16 group, element;
  DcmEVR vr;
  const char* value;
};

// What every slice of a series says alike. The private groups are this program's own.
constexpr Element kElements[] = {
    {0x0008, 0x0005, EVR_CS, "ISO_IR 100"},
    {0x0008, 0x0008, EVR_CS, "ORIGINAL\\PRIMARY\\AXIAL\\HELIX"},
    {0x0008, 0x0012, EVR_DA, "20260105"},
    {0x0008, 0x0013, EVR_TM, "101530.000"},
    {0x0008, 0x0016, EVR_UI, UID_CTImageStorage},
    {0x0008, 0x0020, EVR_DA, "20260105"},
    {0x0008, 0x0021, EVR_DA, "20260105"},
    {0x0008, 0x0022, EVR_DA, "20260105"},
    {0x0008, 0x0023, EVR_DA, "20260105"},
    {0x0008, 0x002a, EVR_DT, "20260105101512.250"},
    {0x0008, 0x0030, EVR_TM, "101430.125"},
    {0x0008, 0x0031, EVR_TM, "101510.500"},
    {0x0008, 0x0032, EVR_TM, "101512.250"},
    {0x0008, 0x0033, EVR_TM, "101529.750"},
    {0x0008, 0x0050, EVR_SH, ""},
    {0x0008, 0x0060, EVR_CS, "CT"},
    {0x0008, 0x0070, EVR_LO, "Trephine"},
    {0x0008, 0x0080, EVR_LO, "None"},
    {0x0008, 0x0090, EVR_PN, ""},
    {0x0008, 0x1010, EVR_SH, "PHANTOM1"},
    {0x0008, 0x1030, EVR_LO, "Phantom study"},
    {0x0008, 0x103e, EVR_LO, "Cranium phantom, noisy"},
    {0x0008, 0x1040, EVR_LO, "None"},
    {0x0008, 0x1090, EVR_LO, "Phantom with noise"},
    {0x0010, 0x0010, EVR_PN, "TREPHINE^PHANTOM"},
    {0x0010, 0x0020, EVR_LO, "PHANTOM"},
    {0x0010, 0x0030, EVR_DA, ""},
    {0x0010, 0x0040, EVR_CS, "O"},
    {0x0010, 0x1010, EVR_AS, "040Y"},
    {0x0010, 0x1030, EVR_DS, "70"},
    {0x0018, 0x0015, EVR_CS, "HEAD"},
    {0x0018, 0x0022, EVR_CS, "HELICAL MODE"},
    {0x0018, 0x0060, EVR_DS, "120"},
    {0x0018, 0x0090, EVR_DS, "500"},
    {0x0018, 0x1000, EVR_LO, "0"},
    {0x0018, 0x1020, EVR_LO, "1"},
    {0x0018, 0x1030, EVR_LO, "Head thin slices"},
    {0x0018, 0x1100, EVR_DS, "230"},
    {0x0018, 0x1110, EVR_DS, "949.075012"},
    {0x0018, 0x1111, EVR_DS, "541"},
    {0x0018, 0x1120, EVR_DS, "0"},
    {0x0018, 0x1130, EVR_DS, "143.199997"},
    {0x0018, 0x1140, EVR_CS, "CW"},
    {0x0018, 0x1150, EVR_IS, "500"},
    {0x0018, 0x1151, EVR_IS, "220"},
    {0x0018, 0x1152, EVR_IS, "110"},
    {0x0018, 0x1160, EVR_SH, "HEAD FILTER"},
    {0x0018, 0x1170, EVR_IS, "26400"},
    {0x0018, 0x1190, EVR_DS, "0.7"},
    {0x0018, 0x1210, EVR_SH, "STANDARD"},
    {0x0018, 0x5100, EVR_CS, "HFS"},
    {0x0018, 0x9305, EVR_FD, "0.5"},
    {0x0018, 0x9306, EVR_FD, "0.625"},
    {0x0018, 0x9307, EVR_FD, "40"},
    {0x0018, 0x9309, EVR_FD, "41.25"},
    {0x0018, 0x9310, EVR_FD, "20.625"},
    {0x0018, 0x9311, EVR_FD, "0.515625"},
    {0x0018, 0x9345, EVR_FD, "22.5"},
    {0x0020, 0x0010, EVR_SH, "1"},
    {0x0020, 0x0012, EVR_IS, "1"},
    {0x0020, 0x0037, EVR_DS, "1\\0\\0\\0\\1\\0"},
    {0x0020, 0x1040, EVR_LO, "OM"},
    {0x0020, 0x4000, EVR_LT, "For training, not for diagnosis"},
    {0x0028, 0x0002, EVR_US, "1"},
    {0x0028, 0x0004, EVR_CS, "MONOCHROME2"},
    {0x0028, 0x0100, EVR_US, "16"},
    {0x0028, 0x1050, EVR_DS, "40\\700"},
    {0x0028, 0x1051, EVR_DS, "90\\3200"},
    {0x0028, 0x1053, EVR_DS, "1"},
    {0x0028, 0x1054, EVR_LO, "HU"},
    {0x0028, 0x1055, EVR_LO, "BRAIN\\BONE"},
    {0x0009, 0x0010, EVR_LO, "TREPHINE SOURCE"},
    {0x0009, 0x1001, EVR_LO, "phantom"},
    {0x0009, 0x1002, EVR_SH, "cranium"},
    {0x0009, 0x1027, EVR_SL, "1767608130"},
    {0x0009, 0x10e3, EVR_UI, "2.25.1"},
    {0x0019, 0x0010, EVR_LO, "TREPHINE TUBE"},
    {0x0019, 0x1002, EVR_SL, "912"},
    {0x0019, 0x1003, EVR_DS, "389.75"},
    {0x0019, 0x1004, EVR_DS, "1.0239"},
    {0x0019, 0x100f, EVR_DS, "395.1"},
    {0x0019, 0x1011, EVR_SS, "1"},
    {0x0019, 0x1018, EVR_LO, "S"},
    {0x0019, 0x101a, EVR_LO, "I"},
    {0x0019, 0x1023, EVR_DS, "20.625"},
    {0x0019, 0x1024, EVR_DS, "14.2"},
    {0x0019, 0x1025, EVR_SS, "7"},
    {0x0019, 0x1026, EVR_SL, "0"},
    {0x0019, 0x1027, EVR_DS, "0.5"},
    {0x0019, 0x102c, EVR_SL, "5060"},
    {0x0019, 0x1039, EVR_SS, "4"},
    {0x0019, 0x1042, EVR_SS, "0"},
    {0x0043, 0x0010, EVR_LO, "TREPHINE RECON"},
    {0x0043, 0x1010, EVR_US, "400"},
    {0x0043, 0x1012, EVR_SS, "14\\2\\3"},
    {0x0043, 0x1016, EVR_SS, "2"},
    {0x0043, 0x101a, EVR_SL, "7"},
    {0x0043, 0x1026, EVR_US, "0\\0\\1\\1\\2\\0"},
    {0x0043, 0x1027, EVR_SH, "/0.516:1"},
    {0x0043, 0x1040, EVR_FL, "148.96"},
    {0x0043, 0x1041, EVR_FL, "52.12"},
};

// One slice to write. Its UIDs are numbers under 2.25 (PS3.5 B.2), derived from `series` and `k`.
struct SliceFile {
  const Volume& volume;
  std::uint64_t series;
  int number;  // of the series
  int k;
  SeriesSyntax syntax;
};

std::string uidOf(std::uint64_t n) { return "2.25." + std::to_string(hashOf(n)); }

std::string decimalText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return std::string(text).substr(0, 16);
}

// Keeps the first failure of many calls.
class Filling {
 public:
  explicit Filling(DcmItem& item) : item_(item) {}
  void put(const DcmTag& tag, const std::string& value) {
    if (result_.good()) result_ = item_.putAndInsertString(tag, value.c_str());
  }
  void check(const OFCondition& result) {
    if (result_.good()) result_ = result;
  }
  const OFCondition& result() const { return result_; }

 private:
  DcmItem& item_;
  OFCondition result_ = EC_Normal;
};

// A reference to another object, as sequences hold them.
OFCondition putReference(DcmDataset& data, const DcmTagKey& sequence, const std::string& uid) {
  DcmItem* item = nullptr;
  const OFCondition made = data.findOrCreateSequenceItem(sequence, item, -2);
  if (made.bad()) return made;
  Filling filling(*item);
  filling.put(DCM_ReferencedSOPClassUID, UID_CTImageStorage);
  filling.put(DCM_ReferencedSOPInstanceUID, uid);
  return filling.result();
}

OFCondition putProtocol(DcmDataset& data) {
  DcmItem *request = nullptr, *code = nullptr;
  OFCondition made = data.findOrCreateSequenceItem(DCM_RequestAttributesSequence, request, -2);
  if (made.bad()) return made;
  made = request->findOrCreateSequenceItem(DCM_ScheduledProtocolCodeSequence, code, -2);
  if (made.bad()) return made;
  Filling step(*request), meaning(*code);
  step.put(DCM_ScheduledProcedureStepDescription, "Phantom");
  step.put(DCM_ScheduledProcedureStepID, "1");
  step.put(DCM_RequestedProcedureID, "1");
  meaning.put(DCM_CodeValue, "PHANTOM");
  meaning.put(DCM_CodingSchemeDesignator, "99TREPHINE");
  meaning.put(DCM_CodeMeaning, "Phantom");
  return step.result().bad() ? step.result() : meaning.result();
}

OFCondition fillHeader(DcmDataset& data, const SliceFile& slice) {
  const GridGeometry& g = slice.volume.geometry;
  Filling filling(data);
  const bool hu_as_words = slice.syntax == SeriesSyntax::int16;
  for (const Element& e : kElements) filling.put(DcmTag(e.group, e.element, e.vr), e.value);

  const Vec3 at_mm = g.toPatient_mm(Vec3(0.0, 0.0, slice.k));
  const std::uint64_t series = hashOf(slice.series);
  filling.put(DCM_SOPInstanceUID, uidOf(series + 16 + std::uint64_t(slice.k)));
  filling.put(DCM_StudyInstanceUID, uidOf(1));  // one study for all
  filling.put(DCM_SeriesInstanceUID, uidOf(series));
  filling.put(DCM_FrameOfReferenceUID, uidOf(2));
  filling.put(DCM_SeriesNumber, std::to_string(slice.number));
  filling.put(DCM_InstanceNumber, std::to_string(slice.k + 1));
  filling.put(DCM_ImagePositionPatient, decimalText(at_mm.x) + "\\" + decimalText(at_mm.y) + "\\" +
                                            decimalText(at_mm.z));
  filling.put(DCM_SliceLocation, decimalText(at_mm.z));
  filling.put(DCM_SliceThickness, decimalText(g.spacing_mm.z));
  filling.put(DCM_PixelSpacing,
              decimalText(g.spacing_mm.y) + "\\" + decimalText(g.spacing_mm.x));
  filling.put(DCM_Rows, std::to_string(g.size[1]));
  filling.put(DCM_Columns, std::to_string(g.size[0]));
  filling.put(DCM_BitsStored, hu_as_words ? "16" : "12");
  filling.put(DCM_HighBit, hu_as_words ? "15" : "11");
  filling.put(DCM_PixelRepresentation, hu_as_words ? "1" : "0");
  filling.put(DCM_RescaleIntercept, hu_as_words ? "0" : std::to_string(kLowestHu));

  filling.check(putReference(data, DCM_ReferencedImageSequence, uidOf(3)));
  filling.check(putReference(data, DCM_SourceImageSequence, uidOf(4)));
  filling.check(putProtocol(data));
  std::vector<Uint8> block(512);
  for (std::size_t n = 0; n < block.size(); ++n) block[n] = Uint8(hashOf(n));
  filling.check(data.putAndInsertUint8Array(DcmTag(0x0043, 0x1029, EVR_OB), block.data(), 512));
  filling.check(data.putAndInsertUint8Array(DcmTag(0x0043, 0x102a, EVR_OB), block.data(), 512));
  return filling.result();
}

OFCondition putWords(DcmDataset& data, const SliceFile& slice) {
  const GridGeometry& g = slice.volume.geometry;
  const std::size_t count = std::size_t(g.size[0]) * std::size_t(g.size[1]);
  const std::int16_t* hu = &slice.volume.hu[std::size_t(slice.k) * count];
  const int intercept = slice.syntax == SeriesSyntax::int16 ? 0 : kLowestHu;
  std::vector<Uint16> words(count);
  std::transform(hu, hu + count, words.begin(),
                 [&](std::int16_t v) { return Uint16(v - intercept); });
  if (slice.syntax != SeriesSyntax::j2k) {
    return data.putAndInsertUint16Array(DCM_PixelData, words.data(), count);
  }
  std::vector<std::uint8_t> code = encodeJ2k(words, g.size[0], g.size[1], 12);
  if (code.empty()) return EC_CorruptedData;
  code.resize(code.size() + code.size() % 2);
  auto sequence = std::make_unique<DcmPixelSequence>(DcmTag(DCM_PixelData, EVR_OB));
  for (const bool pixels : {false, true}) {  // the first item, an offset table, stays empty
    auto item = std::make_unique<DcmPixelItem>(DcmTag(DCM_Item, EVR_OB));
    OFCondition done = EC_Normal;
    if (pixels) done = item->putUint8Array(code.data(), code.size());
    if (done.good()) done = sequence->insert(item.get());
    if (done.bad()) return done;
    static_cast<void>(item.release());
  }
  auto pixel_data = std::make_unique<DcmPixelData>(DCM_PixelData);
  pixel_data->putOriginalRepresentation(EXS_JPEG2000LosslessOnly, nullptr, sequence.release());
  const OFCondition inserted = data.insert(pixel_data.get(), OFTrue);
  if (inserted.good()) static_cast<void>(pixel_data.release());
  return inserted;
}

E_TransferSyntax transferSyntaxOf(SeriesSyntax syntax) {
  switch (syntax) {
    case SeriesSyntax::int16:
    case SeriesSyntax::u12:
      break;
    case SeriesSyntax::big_endian:
      return EXS_BigEndianExplicit;
    case SeriesSyntax::deflated:
      return EXS_DeflatedLittleEndianExplicit;
    case SeriesSyntax::rle:
      return EXS_RLELossless;
    case SeriesSyntax::jpegls:
      return EXS_JPEGLSLossless;
    case SeriesSyntax::jpegll:
      return EXS_JPEGProcess14SV1;
    case SeriesSyntax::j2k:
      return EXS_JPEG2000LosslessOnly;
  }
  return EXS_LittleEndianExplicit;
}

void registerEncoders() {
  static std::once_flag once;
  std::call_once(once, [] {
    DcmRLEEncoderRegistration::registerCodecs();
    DJEncoderRegistration::registerCodecs();
    DJLSEncoderRegistration::registerCodecs(0, 0, 0, 0, OFFalse);  // the words as they are
  });
}

Status writeSlice(const SliceFile& slice, const fs::path& file) {
  DcmFileFormat format;
  DcmDataset& data = *format.getDataset();
  const E_TransferSyntax syntax = transferSyntaxOf(slice.syntax);
  OFCondition done = fillHeader(data, slice);
  if (done.good()) done = putWords(data, slice);
  if (done.good()) {
    const DJ_RPLossless jpegll(1, 0);
    const DJLSRepresentationParameter jpegls(0, OFTrue);
    const DcmRepresentationParameter* parameter = nullptr;
    if (slice.syntax == SeriesSyntax::jpegll) parameter = &jpegll;
    if (slice.syntax == SeriesSyntax::jpegls) parameter = &jpegls;
    done = data.chooseRepresentation(syntax, parameter);
  }
  if (done.good()) done = format.saveFile(OFFilename(file.c_str()), syntax);
  if (done.good()) return {};
  return Error{"CANNOT_WRITE", std::string("A slice could not be written: ") + done.text(),
               file.parent_path().string(), "See whether the disk is full"};
}

// Writes what `slice` gives for 0..count-1.
template <class Slice>
Status writeAll(int count, const fs::path& folder, const std::string& step,
                const ProgressShare& share, const Slice& slice) {
  if (Status made = makeFolder(folder); !made) return made;
  registerEncoders();
  std::mutex mutex;
  Status result;
  const Status ran = forEachFile(
      std::size_t(count), share.progress, {share.from, share.to, step}, [&](std::size_t n) {
        char name[32];
        std::snprintf(name, sizeof name, "I%06d", int(n) + 1);
        const Status written = writeSlice(slice(int(n)), folder / name);
        const std::lock_guard lock(mutex);
        if (!written && result) result = written;
      });
  return ran ? result : ran;
}

}  // namespace

Result<Volume> makeNoisyCt(const Index3& size, const ProgressShare& share) {
  for (int axis = 0; axis < 3; ++axis) {
    if (size[axis] < 2 || size[axis] > 2048) {
      return Error{"BAD_ARGUMENT", "A series has 2 to 2048 voxels along an edge", "size", ""};
    }
  }
  share.progress.at(share.from, "Making the phantom");
  const Result<PhantomTruth> truth = phantomTruth("cranium");
  if (!truth) return truth.error();
  const Volume coarse = makePhantomOn(
      *truth, geometryOf({(size[0] + 1) / 2, (size[1] + 1) / 2, (size[2] + 1) / 2}), 0.0);
  Volume fine{geometryOf(size), {}};
  fine.hu.resize(fine.geometry.voxelCount());
  const Refinement refinement(coarse, fine);
  const Status done = forEachFile(
      std::size_t(size[2]), share.progress,
      {0.5 * (share.from + share.to), share.to, "Making the phantom"},
      [&](std::size_t k) { refinement.slice(int(k)); });
  if (!done) return done.error();
  return fine;
}

Status writeSeries(const Volume& volume, SeriesSyntax syntax, const fs::path& folder,
                   const ProgressShare& share) {
  const int number = 1 + int(syntax);
  return writeAll(volume.geometry.size[2], folder, "Writing " + nameOf(kSeriesSyntaxes, syntax),
                  share, [&](int n) {
                    return SliceFile{volume, std::uint64_t(number), number, n, syntax};
                  });
}

Status writeManySeries(int series, int slices, const fs::path& folder,
                       const ProgressShare& share) {
  Result<Volume> volume =
      makeNoisyCt({64, 64, slices}, {share.progress, share.from, 0.5 * (share.from + share.to)});
  if (!volume) return volume.error();
  return writeAll(series * slices, folder, "Writing headers",
                  {share.progress, 0.5 * (share.from + share.to), share.to}, [&](int n) {
                    const int which = n / slices;
                    return SliceFile{*volume, 1000 + std::uint64_t(which), 100 + which, n % slices,
                                     SeriesSyntax::int16};
                  });
}

}  // namespace trephine
