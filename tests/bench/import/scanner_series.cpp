#include "bench/import/scanner_series.h"

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
#include <cstdio>
#include <memory>
#include <mutex>

#include "base/codes.h"
#include "bench/import/j2k_encoder.h"
#include "bench/import/noisy_ct.h"
#include "bench/import/scanner_header.h"
#include "imaging/common/workers.h"
#include "imaging/dicom/ct_writer.h"

namespace trephine::bench {

namespace {

namespace fs = std::filesystem;

constexpr int kWrittenIntercept = -1024;  // of imaging's writer, for HU from there up

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

OFCondition putJ2k(DcmDataset& data, const std::vector<Uint16>& words) {
  Uint16 columns = 0, rows = 0;
  data.findAndGetUint16(DCM_Columns, columns);
  data.findAndGetUint16(DCM_Rows, rows);
  std::vector<std::uint8_t> code = encodeJ2k(words, columns, rows, 12);
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

// Unsigned words of 16 bits become signed ones of 16 without an intercept, or are said to have 12.
OFCondition storeAs(SeriesSyntax syntax, DcmDataset& data) {
  const bool int16 = syntax == SeriesSyntax::int16;
  const Uint16* written = nullptr;
  unsigned long count = 0;
  OFCondition done = data.findAndGetUint16Array(DCM_PixelData, written, &count);
  if (done.bad()) return done;
  std::vector<Uint16> words(written, written + count);
  if (int16) {
    for (Uint16& word : words) word = Uint16(word + kWrittenIntercept);
    done = data.putAndInsertUint16Array(DCM_PixelData, words.data(), count);
    if (done.good()) done = data.putAndInsertString(DCM_RescaleIntercept, "0");
  }
  if (done.good()) done = data.putAndInsertUint16(DCM_BitsStored, int16 ? 16 : 12);
  if (done.good()) done = data.putAndInsertUint16(DCM_HighBit, int16 ? 15 : 11);
  if (done.good()) done = data.putAndInsertUint16(DCM_PixelRepresentation, int16 ? 1 : 0);
  if (done.good() && syntax == SeriesSyntax::j2k) done = putJ2k(data, words);
  if (done.bad()) return done;
  const DJ_RPLossless jpegll(1, 0);
  const DJLSRepresentationParameter jpegls(0, OFTrue);
  const DcmRepresentationParameter* parameter = nullptr;
  if (syntax == SeriesSyntax::jpegll) parameter = &jpegll;
  if (syntax == SeriesSyntax::jpegls) parameter = &jpegls;
  return data.chooseRepresentation(transferSyntaxOf(syntax), parameter);
}

// A slice of imaging's writer, of which series it is, and where it goes.
struct Slice {
  fs::path from;
  int series_number;
  fs::path to;
};

Status convert(const Slice& slice, SeriesSyntax syntax) {
  DcmFileFormat format;
  OFCondition done = format.loadFile(OFFilename(slice.from.c_str()));
  if (done.good()) done = putScannerHeader(*format.getDataset(), slice.series_number);
  if (done.good()) done = storeAs(syntax, *format.getDataset());
  if (done.good()) done = format.saveFile(OFFilename(slice.to.c_str()), transferSyntaxOf(syntax));
  if (done.good()) return {};
  return Error{code::kCannotWrite, std::string("A slice could not be written: ") + done.text(),
               slice.to.parent_path().string(), "See whether the disk is full"};
}

Status convertAll(const std::vector<Slice>& slices, SeriesSyntax syntax, const ProgressPart& part,
                  const Progress& progress) {
  registerEncoders();
  std::mutex mutex;
  Status result;
  const Status ran = forEachFile(slices.size(), progress, part, [&](std::size_t n) {
    const Status written = convert(slices[n], syntax);
    const std::lock_guard lock(mutex);
    if (!written && result) result = written;
  });
  return ran ? result : ran;
}

// Writes the volume `count` times and turns the slices into what `syntax` says, all in one folder.
Status write(const Volume& volume, int first_number, int count, SeriesSyntax syntax,
             const fs::path& folder, const Progress& progress) {
  const fs::path plain = folder / ".plain";
  std::vector<Slice> slices;
  Status done;
  for (int s = 0; s < count && done; ++s) {
    const Progress writing(progress, 0.5 * s / count, 0.5 * (s + 1) / count);
    const std::string number = std::to_string(first_number + s);
    done = writeCtSeries(volume, {number, "HEAD"}, plain / number, writing);
    for (int k = 0; k < volume.geometry.size[2]; ++k) {
      char from[32], to[32];
      std::snprintf(from, sizeof from, "IM%04d.dcm", k + 1);
      std::snprintf(to, sizeof to, "I%06d", int(slices.size()) + 1);
      slices.push_back({plain / number / from, first_number + s, folder / to});
    }
  }
  const std::string step = "Writing " + nameOf(kSeriesSyntaxes, syntax);
  if (done) done = convertAll(slices, syntax, {0.5, 1.0, step}, progress);
  std::error_code none;
  fs::remove_all(plain, none);
  return done;
}

}  // namespace

std::vector<std::string> seriesNames() {
  std::vector<std::string> names;
  for (const auto& [name, syntax] : kSeriesSyntaxes) names.emplace_back(name);
  return names;
}

Status writeSeries(const Volume& volume, SeriesSyntax syntax, const fs::path& folder,
                   const Progress& progress) {
  return write(volume, 1 + int(syntax), 1, syntax, folder, progress);
}

Status writeManySeries(int series, int slices, const fs::path& folder, const Progress& progress) {
  const Progress making(progress, 0.0, 0.3), writing(progress, 0.3, 1.0);
  const Result<Volume> volume = makeNoisyCt({64, 64, slices}, making);
  if (!volume) return volume.error();
  return write(*volume, 100, series, SeriesSyntax::int16, folder, writing);
}

Result<std::vector<KnownVolume>> writeScannerSeries(const ImportSeries& series,
                                                    const fs::path& folder,
                                                    const Progress& progress) {
  const double part = 1.0 / double(series.names.size() + 2);
  const Progress making(progress, 0.0, part), scan(progress, 1.0 - part, 1.0);
  const Result<Volume> volume = makeNoisyCt(series.size, making);
  if (!volume) return volume.error();
  double from = part;
  for (const std::string& name : series.names) {
    const Progress writing(progress, from, from + part);
    const Status written =
        writeSeries(*volume, *kindOf(kSeriesSyntaxes, name), folder / name, writing);
    if (!written) return written.error();
    from += part;
  }
  const Status written =
      writeManySeries(series.scan_series, series.scan_slices, folder / "scan", scan);
  if (!written) return written.error();
  return std::vector<KnownVolume>(series.names.size(), {volume->geometry, volumeSha256(*volume)});
}

}  // namespace trephine::bench
