#include "lab/import/import_series.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>
#include <dcmtk/dcmdata/dcrleerg.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmjpeg/djencode.h>
#include <dcmtk/dcmjpeg/djrplol.h>
#include <dcmtk/dcmjpls/djencode.h>
#include <dcmtk/dcmjpls/djrparam.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <mutex>
#include <vector>

#include "base/file.h"
#include "imaging/common/workers.h"
#include "lab/import/ct_header.h"
#include "lab/import/j2k_encoder.h"
#include "volume/phantom.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr Vec3 kExtent_mm{230.0, 230.0, 180.0};
constexpr double kNoiseHu = 15.0;
constexpr std::uint64_t kMostVoxels = std::uint64_t(1) << 28;
constexpr int kLowestHu = -1024, kHighestHu = 3071;

// The sum of a hash's eight bytes about its mean: variance 8 * (256^2 - 1) / 12 = 43690.
int whiteNoise(std::uint64_t n) {
  const std::uint64_t h = hashedNumber(n);
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
        *out++ =
            std::int16_t(std::floor(std::clamp(hu, double(kLowestHu), double(kHighestHu)) + 0.5));
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

// One slice to write. `series` tells its UIDs from others'.
struct SliceFile {
  const Volume& volume;
  std::uint64_t series;
  int number;  // of the series
  int k;
  SeriesSyntax syntax;
};

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
  const bool hu_as_words = slice.syntax == SeriesSyntax::int16;
  OFCondition done =
      putCtHeader(data, {slice.volume.geometry, slice.series, slice.number, slice.k,
                         hu_as_words ? 16 : 12, hu_as_words, hu_as_words ? 0 : kLowestHu});
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

// Calls work(k) for every k below `count`, on a few threads.
Status forEachSlice(int count, const std::string& step, const ProgressShare& share,
                    const std::function<void(int)>& work) {
  const Status ran = forEachFile(std::size_t(count), share.progress, {share.from, share.to, step},
                                 [&](std::size_t k) { work(int(k)); });
  if (ran) return ran;
  const bool cancelled = ran.error().code == "CANCELLED";
  return Error{
      ran.error().code,
      cancelled ? "The measurement was cancelled" : "There is not enough memory to make the series",
      "measure import", cancelled ? "" : "Close other programs and try again"};
}

// Writes what `slice` gives for 0..count-1.
template <class Slice>
Status writeAll(int count, const fs::path& folder, const std::string& step,
                const ProgressShare& share, const Slice& slice) {
  if (Status made = makeFolder(folder); !made) return made;
  registerEncoders();
  std::mutex mutex;
  Status result;
  const Status ran = forEachSlice(count, step, share, [&](int n) {
    char name[32];
    std::snprintf(name, sizeof name, "I%06d", n + 1);
    const Status written = writeSlice(slice(n), folder / name);
    const std::lock_guard lock(mutex);
    if (!written && result) result = written;
  });
  return ran ? result : ran;
}

}  // namespace

Status checkSeriesSize(const Index3& size) {
  std::uint64_t voxels = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (size[axis] < 2 || size[axis] > 2048) voxels = kMostVoxels;
    voxels *= std::uint64_t(std::clamp(size[axis], 2, 2048));
  }
  if (voxels <= kMostVoxels) return {};
  return Error{"BAD_ARGUMENT",
               "A series has 2 to 2048 voxels along an edge, and 2^28 (512 MB) in all", "size", ""};
}

Result<Volume> makeNoisyCt(const Index3& size, const ProgressShare& share) {
  if (Status can = checkSeriesSize(size); !can) return can.error();
  share.progress.at(share.from, "Making the phantom");
  const Result<PhantomTruth> truth = phantomTruth("cranium");
  if (!truth) return truth.error();
  const Volume coarse = makePhantomOn(
      *truth, geometryOf({(size[0] + 1) / 2, (size[1] + 1) / 2, (size[2] + 1) / 2}), 0.0);
  Volume fine{geometryOf(size), {}};
  fine.hu.resize(fine.geometry.voxelCount());
  const Refinement refinement(coarse, fine);
  const Status done = forEachSlice(size[2], "Making the phantom",
                                   {share.progress, 0.5 * (share.from + share.to), share.to},
                                   [&](int k) { refinement.slice(k); });
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

Status writeManySeries(int series, int slices, const fs::path& folder, const ProgressShare& share) {
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
