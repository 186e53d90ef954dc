// One DICOM file: the headers of its frames as plain values. Their words: dicom_pixels.h.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/math.h"
#include "base/progress.h"
#include "base/result.h"
#include "imaging/common/detail/stored_values.h"
#include "imaging/common/source_identity.h"

namespace trephine {

// Pixels of the largest slice. More are refused before anything is allocated for them: a compressed
// slice can claim any size.
constexpr std::uint64_t kLargestSlice = std::uint64_t(8192) * 8192;

// Why a slice's pixels cannot be had, though its header names its series.
enum class Defect {
  none,
  cut,            // the file ends before its header or its pixels do
  size_mismatch,  // the pixel data are not as long as rows, columns and bits say
};

// Where a file keeps its pixels.
struct PixelPlace {
  struct Fragment {
    std::uint64_t offset = 0;
    std::uint32_t bytes = 0;
  };
  std::uint64_t offset = 0;  // of the value in the (inflated) file
  std::uint64_t bytes = 0;   // of the value, where it is not encapsulated
  bool encapsulated = false;
  std::vector<std::vector<Fragment>> frames;  // encapsulated: the fragments of each frame
};

// What tells two slices at one place apart, in the order in which it is asked.
enum PhaseKey {
  kTemporalPosition,
  kCardiacPercent,
  kAcquisitionNumber,
  kTriggerTime,
  kTriggerDelay,
  kAcquisitionTime,
  kContentTime,
  kPhaseKeys
};

// One frame: of a classic file its only one.
struct DicomHeader {
  std::filesystem::path file;
  std::uint64_t file_bytes = 0;
  int frame = 0;  // from 0

  std::string sop_class, sop_instance, study_uid, series_uid, frame_of_reference;
  std::string series_key;  // where the Series UID was emptied: what tells series apart instead
  std::string modality, description, body_part;  // description: valid UTF-8
  std::string transfer_syntax;                   // UID
  std::string rescale_type;
  std::vector<std::string> image_type;
  std::string instance_number;
  // Name, ID, birth date and sex of whom it is of, each equal where they are equal, empty where
  // they are; nothing else can be told from them. Compared, never written anywhere.
  std::array<std::string, 4> patient;
  std::string acquired;  // the day, as DICOM writes one; empty where absent
  // Of an enhanced image in several files: what all of them share, its number from 1 on, and how
  // many there are, 0 where that is not said.
  std::string concatenation;
  int in_concatenation = 0, concatenated = 0;
  // For the screen alone, as ScreenNames has them.
  std::string patient_name, study_text;
  // Its texts, without folders and files; shared by the frames of a file.
  std::shared_ptr<const SourceIdentity> identity;
  // Set by grouping: of a series whose slices differ in what may be its writer's doing, the part
  // that it belongs to; 0 is the largest.
  int part = 0;
  // What was made of what was scanned, as the standard's terms say; empty where absent.
  std::string volumetric, technique, presentation;
  bool modality_lut = false;  // stored values become others by a table
  struct ValueMap {
    std::string unit;  // as UCUM; empty where it is not said
    std::optional<double> slope, intercept;
  };
  std::vector<ValueMap> value_maps;  // real-world values, beside slope and intercept
  std::string kernel;                // of the reconstruction, one line; empty where absent
  // Manufacturer, model and serial number; "HFS" and the like; the contrast agent.
  std::string scanner, patient_position, contrast;
  // What the header says beside positions; none where absent or zero.
  std::optional<double> kvp, thickness_mm, spacing_between_mm, tilt_deg;
  std::optional<double> location_mm;  // along the patient's axis, in its writer's own sense
  std::array<std::optional<double>, kPhaseKeys> phase;

  bool has_pixels = false;
  int rows = 0, columns = 0, samples = 1, frames = 1;
  int bits_allocated = 0;
  std::string photometric;
  bool lossy = false;
  bool big_endian = false;
  bool swapped_pairs = false;    // 8-bit pixels in big-endian words
  bool ambiguous_order = false;  // 16-bit words declared as bytes in a big-endian file
  bool overlay_bits = false;     // of compressed pixels: an overlay lies in their upper bits
  int said_bits_stored = 0;      // where the codestream has more, which `format` has then; else 0
  StoredFormat format;           // slope and intercept 1 and 0 where absent, slope 0 read as 1
  bool rescale_given = true;     // false where absent or slope 0
  bool intercept_given = true;
  bool rescale_bad = false;  // there, but no number

  std::optional<Vec3> position_mm;
  std::optional<std::array<double, 6>> orientation;
  std::optional<std::array<double, 2>> pixel_spacing_mm;  // between rows, between columns

  std::shared_ptr<const PixelPlace> pixels;  // shared by the frames of a file
  Defect defect = Defect::none;
  std::string defect_text;

  std::uint64_t pixelCount() const { return std::uint64_t(rows) * std::uint64_t(columns); }
  // Whether a frame is one grey sample a pixel, of a size and in bits that PixelReader can read.
  bool holdsGreyWords() const {
    return samples == 1 && (bits_allocated == 8 || bits_allocated == 16) &&
           format.bits_stored >= 1 && format.bits_stored <= bits_allocated &&
           format.high_bit >= format.bits_stored - 1 && format.high_bit < bits_allocated &&
           rows > 0 && columns > 0 && pixelCount() <= kLargestSlice;
  }
  // Bytes of one frame's stored words.
  std::uint64_t frameBytes() const {
    return pixelCount() * std::uint64_t(samples) * std::uint64_t(bits_allocated / 8);
  }
};

// Reads everything but the pixels, once; one header a frame. The Error's `what` is the reason for
// skipping the file, without its name: it may not be read, is empty, packed, no DICOM, cut short, a
// DICOMDIR, or lacks a UID.
// Called on the threads of forEachFile only (deep recursion).
Result<std::vector<DicomHeader>> readDicomHeaders(const std::filesystem::path& file,
                                                  std::uint64_t file_bytes,
                                                  const Progress& progress = Progress());

}  // namespace trephine
