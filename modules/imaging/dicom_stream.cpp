#include "imaging/dicom_stream.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

namespace trephine {

namespace {

// A level of nesting takes at least 16 bytes of file and up to 2.1 KB of stack (measured), so that
// a file of this size cannot exhaust a worker's stack; the items of larger ones are counted first.
constexpr std::uint64_t kSafeBytes = std::uint64_t(2) << 20;
constexpr std::size_t kMostItems = 100000;
constexpr offile_off_t kMostSkipped = offile_off_t(256) << 20;  // inflated in about a second

// Stands for a value that was skipped: it cannot be had later.
class NoValue : public DcmInputStreamFactory {
 public:
  DcmInputStream* create() const override { return nullptr; }
  DcmInputStreamFactory* clone() const override { return new NoValue; }
  DcmInputStreamFactoryType ident() const override { return DFT_DcmInputFileStreamFactory; }
};

}  // namespace

DicomStream::DicomStream(const std::filesystem::path& file)
    : DcmInputFileStream(OFFilename(file.c_str())) {}

offile_off_t DicomStream::avail() {
  if (std::uint64_t(read_) > kSafeBytes || skipped_ > kMostSkipped) return 0;
  return DcmInputFileStream::avail();
}

offile_off_t DicomStream::read(void* to, offile_off_t bytes) {
  const offile_off_t count = DcmInputFileStream::read(to, bytes);
  if (deflated_) read_ += count;
  const std::size_t fresh = std::min(std::size_t(std::max<offile_off_t>(count, 0)), newest_.size());
  if (fresh == 0) return count;
  const std::size_t kept = newest_.size() - fresh;
  std::memmove(newest_.data(), newest_.data() + fresh, kept);
  std::memcpy(newest_.data() + kept,
              static_cast<const std::uint8_t*>(to) + (std::size_t(count) - fresh), fresh);
  return count;
}

offile_off_t DicomStream::skip(offile_off_t bytes) {
  if (deflated_) skipped_ += bytes;
  return skipped_ > kMostSkipped ? 0 : DcmInputFileStream::skip(bytes);
}

OFCondition DicomStream::installCompressionFilter(E_StreamCompression filter) {
  deflated_ = true;
  return DcmInputFileStream::installCompressionFilter(filter);
}

DcmInputStreamFactory* DicomStream::newFactory() const {
  return deflated_ ? new NoValue : DcmInputFileStream::newFactory();
}

bool nestsTooDeeply(const std::filesystem::path& file, std::uint64_t file_bytes) {
  if (file_bytes <= kSafeBytes) return false;
  constexpr std::string_view kLittle("\xFE\xFF\x00\xE0", 4), kBig("\xFF\xFE\xE0\x00", 4);
  std::ifstream in(file, std::ios::binary);
  std::string block(std::size_t(1) << 20, '\0');
  std::size_t items = 0, kept = 0;
  while (in) {
    in.read(block.data() + kept, std::streamsize(block.size() - kept));
    const std::string_view view(block.data(), kept + std::size_t(in.gcount()));
    for (const std::string_view tag : {kLittle, kBig}) {
      for (std::size_t at = view.find(tag); at != view.npos; at = view.find(tag, at + 4)) ++items;
    }
    if (items > kMostItems) return true;
    kept = std::min<std::size_t>(3, view.size());  // a tag across two blocks
    std::memmove(block.data(), view.data() + view.size() - kept, kept);
  }
  return false;
}

}  // namespace trephine
