// Where a DICOM file keeps its pixels, and its frames' stored words.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "imaging/dicom/detail/dicom_file.h"
#include "imaging/dicom/detail/stream_bounds.h"

namespace trephine {

// Of what was read before `value_offset`, where the value of Pixel Data begins, `newest` are the
// last bytes; an encapsulated value's items are walked. Null where it is no Pixel Data element.
// Frames of an encapsulated value are told apart by their number of fragments or the basic offset
// table; none are given where that fails. `cut` is set where the file ends before the value does;
// frames that are not whole then have no fragments.
std::shared_ptr<const PixelPlace> findPixels(const std::filesystem::path& file,
                                             std::uint64_t file_bytes, std::uint64_t value_offset,
                                             const std::array<std::uint8_t, 12>& newest,
                                             bool explicit_vr, bool big_endian, int frames,
                                             std::string& vr, bool& cut);

// A part of a file; nothing where it is not all there.
std::optional<std::vector<std::uint8_t>> readBytes(const std::filesystem::path& file,
                                                   std::uint64_t offset, std::uint64_t bytes);

// Reads frames of one series. Any number of threads at once.
class PixelReader {
 public:
  // Cancelled with `progress`, which outlives it: what is being read then fails. `bounds` are those
  // that the headers were read with.
  explicit PixelReader(const Progress& progress, const StreamBounds& bounds = kSliceBounds)
      : progress_(progress), bounds_(bounds) {}

  // The frame's words in native byte order into `words` (rows * columns; 8-bit pixels widened).
  // Fails, with the reason in `what`, unless the file holds exactly what `header` said.
  Status read(const DicomHeader& header, std::int16_t* words);
  // `bytes` of Pixel Data as they stand, from the `from`th, where they are not encapsulated.
  // `header` says how many there are (pixels->bytes). A deflated file is inflated by the first
  // call, on a thread of forEachFile (deep recursion).
  Status read(const DicomHeader& header, std::uint64_t from, std::uint64_t bytes, std::uint8_t* to);

 private:
  using Bytes = std::vector<std::uint8_t>;
  Result<std::shared_ptr<const Bytes>> inflated(const DicomHeader& header, std::uint64_t needed,
                                                bool keep);

  const Progress& progress_;
  const StreamBounds bounds_;
  std::mutex mutex_;
  std::map<std::filesystem::path, std::shared_ptr<const Bytes>> inflated_;  // multi-frame files
};

}  // namespace trephine
