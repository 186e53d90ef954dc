// One DICOM file: its header as plain values, and its stored pixel words. The only file of this
// room besides ct_writer that knows DCMTK.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/math.h"
#include "base/result.h"
#include "imaging/stored_values.h"

namespace trephine {

// Why a slice's pixels cannot be had, though its header names its series.
enum class Defect {
  none,
  cut,            // the file ends before its header or its pixels do
  size_mismatch,  // the pixel data are not as long as rows, columns and bits say
};

struct DicomHeader {
  std::filesystem::path file;
  std::uint64_t file_bytes = 0;

  std::string sop_class, sop_instance, study_uid, series_uid, frame_of_reference;
  std::string modality, description;  // description: valid UTF-8
  std::string transfer_syntax;        // UID
  std::string rescale_type;
  std::vector<std::string> image_type;
  std::string instance_number;

  bool has_pixels = false;
  int rows = 0, columns = 0, samples = 1, frames = 1;
  int bits_allocated = 0;
  std::string photometric;
  bool lossy = false;
  bool ambiguous_order = false;  // 16-bit words declared as bytes in a big-endian file
  StoredFormat format;           // slope and intercept 1 and 0 where absent, slope 0 read as 1
  bool rescale_given = true;     // false where absent or slope 0
  bool rescale_bad = false;      // there, but no number

  std::optional<Vec3> position_mm;
  std::optional<std::array<double, 6>> orientation;
  std::optional<std::array<double, 2>> pixel_spacing_mm;  // between rows, between columns

  Defect defect = Defect::none;
  std::string defect_text;

  // Bytes of one frame's stored words.
  std::uint64_t frameBytes() const {
    return std::uint64_t(rows) * std::uint64_t(columns) * std::uint64_t(bits_allocated / 8);
  }
};

// Reads everything but the pixels. The Error's `what` is the reason for skipping the file, without
// its name: it is empty, no DICOM, cut short, a DICOMDIR, or lacks a UID. Called on the threads of
// forEachFile only (deep recursion).
Result<DicomHeader> readDicomHeader(const std::filesystem::path& file, std::uint64_t file_bytes);

// Reads the first frame's words, native byte order, into `words` (rows * columns). Fails, with the
// reason in `what`, unless the file holds exactly what `header` said. Threads: as above.
Status readStoredWords(const DicomHeader& header, std::int16_t* words);

// "JPEG 2000 (Lossless only)"; "unknown" for a UID that nobody published.
std::string transferSyntaxName(const std::string& uid);
bool isReadableTransferSyntax(const std::string& uid);

}  // namespace trephine
