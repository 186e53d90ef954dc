// A DICOM file for DCMTK's parser, which believes whatever a file says of its lengths and follows
// any nesting by recursion. For the files of this room that know DCMTK.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcistrma.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <shared_mutex>
#include <string_view>

#include "base/descriptor.h"
#include "base/progress.h"
#include "imaging/dicom/detail/stream_bounds.h"

namespace trephine {

// No value that we read is longer: longer ones stay in the file.
constexpr Uint32 kLongestValue = 16384;

// Whether the first bytes, 132 or more, can be DICOM: the preamble's mark, or a first element of
// group 2 or 8. DCMTK itself takes any bytes for a data set without a preamble.
bool looksLikeDicom(std::string_view head);

// Held alone while DCMTK's rule for elements of unknown kind and length (UN), which is one for the
// whole program, is another; held shared by whoever parses.
std::shared_mutex& unknownRule();

// The bytes of a file, a block at a time: DCMTK asks for a few at once, and often where it stands.
class FileBlocks : public DcmProducer {
 public:
  // Once `progress` is cancelled, the file ends. It may be null, or outlives this.
  explicit FileBlocks(const std::filesystem::path& file, const Progress* progress = nullptr);
  FileBlocks(const FileBlocks&) = delete;
  FileBlocks& operator=(const FileBlocks&) = delete;

  OFBool good() const override;
  OFCondition status() const override;
  OFBool eos() override;
  offile_off_t avail() override;
  offile_off_t read(void* to, offile_off_t bytes) override;
  offile_off_t skip(offile_off_t bytes) override;
  void putback(offile_off_t bytes) override;

  // What the file begins with, `most` bytes or less. Until the next call of any other member.
  std::string_view beginning(std::size_t most);

 private:
  void fill(offile_off_t from);

  Descriptor file_;
  const Progress* progress_;
  bool good_ = false;
  offile_off_t at_ = 0, end_ = 0;
  offile_off_t block_at_ = 0, held_ = 0;
  std::array<char, 8192> block_;  // most headers
};

// DCMTK leaves long values in a file, but takes those of a deflated one into memory, gigabytes if
// it says so. This stream has them skipped, and ends at its bounds.
class DicomStream : public DcmInputStream {
 public:
  // Made in the function that has it parsed. `progress`: as that of FileBlocks.
  explicit DicomStream(const std::filesystem::path& file, const StreamBounds& bounds = kSliceBounds,
                       const Progress* progress = nullptr);

  // What the file begins with, `most` bytes or less. Until the next call of any other member.
  std::string_view beginning(std::size_t most) { return blocks_.beginning(most); }
  // The last bytes that were read, the newest at the end: after readUntilTag an element's head.
  // Zeros after bytes that were skipped.
  const std::array<std::uint8_t, 12>& newest() const { return newest_; }

  // Whether it ended because sequences nest so deep that the thread's stack would not hold them: a
  // level takes up to 2.1 KB of it (measured).
  bool isTooDeep() const { return too_deep_; }
  // Whether it ended because the header has more bytes, elements or items than any real one, or
  // nothing but zeros.
  bool isTooLong() const { return too_long_; }

  offile_off_t avail() override;
  offile_off_t read(void* to, offile_off_t bytes) override;
  offile_off_t skip(offile_off_t bytes) override;
  OFCondition installCompressionFilter(E_StreamCompression filter) override;
  DcmInputStreamFactory* newFactory() const override;

 private:
  FileBlocks blocks_;
  std::filesystem::path path_;
  StreamBounds bounds_;
  std::uintptr_t stack_;  // where it was made
  bool deflated_ = false, too_deep_ = false, too_long_ = false;
  std::uint64_t reads_ = 0;
  offile_off_t read_ = 0, skipped_ = 0;  // skipped of a deflated data set
  offile_off_t zeros_ = 0;               // that were read last
  std::size_t items_ = 0;                // that were read
  std::array<std::uint8_t, 12> newest_{};
};

}  // namespace trephine
