#include "imaging/dicom/detail/dicom_stream.h"

#include <dcmtk/dcmdata/dcistrmf.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <string_view>

namespace trephine {

namespace {

// Of a header: each takes some hundred bytes of memory, and eight of the file. Fragments of pixels
// are none of them.
constexpr std::size_t kMostItems = 1000000;
// Each element takes two or three, and a hundred bytes of memory.
constexpr std::uint64_t kMostReads = 20'000'000;
// In a row: DCMTK would take them for elements, eight bytes each. Values are no longer than
// kLongestValue.
constexpr offile_off_t kMostZeros = offile_off_t(1) << 17;
constexpr offile_off_t kMostSkipped = offile_off_t(256) << 20;  // inflated in about a second

// Stands for a value that was skipped: it cannot be had later.
class NoValue : public DcmInputStreamFactory {
 public:
  DcmInputStream* create() const override { return nullptr; }
  DcmInputStreamFactory* clone() const override { return new NoValue; }
  DcmInputStreamFactoryType ident() const override { return DFT_DcmInputFileStreamFactory; }
};

std::uintptr_t stackPlace() {
  return reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
}

}  // namespace

bool looksLikeDicom(std::string_view head) {
  if (head.size() >= 132 && head.substr(128, 4) == "DICM") return true;
  if (head.size() < 16) return false;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(head[i]); };
  const auto isGroup = [](unsigned char high, unsigned char low) {
    return high == 0 && (low == 2 || low == 8);
  };
  const bool little = isGroup(byte(1), byte(0)), big = isGroup(byte(0), byte(1));
  if (!little && !big) return false;
  if (std::isupper(byte(4)) && std::isupper(byte(5))) return true;
  return little && byte(5) < 2 && byte(6) == 0 && byte(7) == 0;  // implicit: a short first value
}

std::shared_mutex& unknownRule() {
  static std::shared_mutex mutex;
  return mutex;
}

FileBlocks::FileBlocks(const std::filesystem::path& file, const Progress* progress)
    : file_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)), progress_(progress) {
  struct stat status {};
  good_ = file_.ok() && ::fstat(file_.get(), &status) == 0;
  end_ = good_ ? offile_off_t(status.st_size) : 0;
}

OFBool FileBlocks::good() const {
  return good_;
}

OFCondition FileBlocks::status() const {
  return good_ ? EC_Normal : EC_InvalidFilename;
}

OFBool FileBlocks::eos() {
  return at_ >= end_;
}

offile_off_t FileBlocks::avail() {
  return std::max<offile_off_t>(end_ - at_, 0);
}

void FileBlocks::fill(offile_off_t from) {
  block_at_ = from;
  held_ = 0;
  if (progress_ && progress_->cancelled()) return;
  held_ =
      std::max<offile_off_t>(::pread(file_.get(), block_.data(), block_.size(), off_t(from)), 0);
}

offile_off_t FileBlocks::read(void* to, offile_off_t bytes) {
  offile_off_t done = 0;
  while (good_ && done < bytes && at_ < end_) {
    if (at_ < block_at_ || at_ >= block_at_ + held_) fill(at_);
    if (held_ == 0) {
      end_ = at_;  // it has become shorter, or cannot be read
      break;
    }
    const offile_off_t part = std::min({block_at_ + held_ - at_, bytes - done, end_ - at_});
    std::memcpy(static_cast<char*>(to) + done, block_.data() + (at_ - block_at_),
                std::size_t(part));
    done += part;
    at_ += part;
  }
  return done;
}

offile_off_t FileBlocks::skip(offile_off_t bytes) {
  const offile_off_t part = std::clamp<offile_off_t>(bytes, 0, avail());
  at_ += part;
  return part;
}

void FileBlocks::putback(offile_off_t bytes) {
  good_ = good_ && bytes <= at_;
  if (good_) at_ -= bytes;
}

std::string_view FileBlocks::beginning(std::size_t most) {
  if (good_ && (held_ == 0 || block_at_ != 0)) fill(0);
  return {block_.data(), std::min(most, std::size_t(held_))};
}

DicomStream::DicomStream(const std::filesystem::path& file, const StreamBounds& bounds,
                         const Progress* progress)
    : DcmInputStream(&blocks_),
      blocks_(file, progress),
      path_(file),
      bounds_(bounds),
      stack_(stackPlace()) {}

offile_off_t DicomStream::avail() {
  const std::uintptr_t now = stackPlace();
  const std::size_t taken = std::max(now, stack_) - std::min(now, stack_);
  too_deep_ = too_deep_ || taken > bounds_.stack;
  too_long_ = too_long_ || read_ > (deflated_ ? bounds_.inflated : bounds_.header) ||
              items_ > kMostItems || reads_ > kMostReads || zeros_ > kMostZeros;
  if (too_deep_ || too_long_ || skipped_ > kMostSkipped) return 0;
  return DcmInputStream::avail();
}

offile_off_t DicomStream::read(void* to, offile_off_t bytes) {
  const offile_off_t count = DcmInputStream::read(to, bytes);
  read_ += count;
  ++reads_;
  const auto* bytes_read = static_cast<const std::uint8_t*>(to);
  const bool zeros = std::all_of(bytes_read, bytes_read + std::max<offile_off_t>(count, 0),
                                 [](std::uint8_t byte) { return byte == 0; });
  zeros_ = zeros ? zeros_ + count : 0;
  const std::size_t fresh = std::min(std::size_t(std::max<offile_off_t>(count, 0)), newest_.size());
  if (fresh == 0) return count;
  const std::size_t kept = newest_.size() - fresh;
  std::memmove(newest_.data(), newest_.data() + fresh, kept);
  std::memcpy(newest_.data() + kept,
              static_cast<const std::uint8_t*>(to) + (std::size_t(count) - fresh), fresh);
  // A tag is read by itself, or with the length that follows it.
  const auto is_item = [&](std::size_t from_end) {
    const std::uint8_t* tag = newest_.data() + newest_.size() - from_end;
    const bool little = tag[0] == 0xFE && tag[1] == 0xFF && tag[2] == 0x00 && tag[3] == 0xE0;
    return little || (tag[0] == 0xFF && tag[1] == 0xFE && tag[2] == 0xE0 && tag[3] == 0x00);
  };
  if ((count <= 4 && is_item(4)) || (count == 8 && is_item(8))) ++items_;
  return count;
}

offile_off_t DicomStream::skip(offile_off_t bytes) {
  if (bytes > 0) newest_.fill(0);
  if (deflated_) skipped_ += bytes;
  return skipped_ > kMostSkipped ? 0 : DcmInputStream::skip(bytes);
}

OFCondition DicomStream::installCompressionFilter(E_StreamCompression filter) {
  deflated_ = true;
  return DcmInputStream::installCompressionFilter(filter);
}

DcmInputStreamFactory* DicomStream::newFactory() const {
  if (deflated_) return new NoValue;
  return new DcmInputFileStreamFactory(OFFilename(path_.c_str()), tell());
}

}  // namespace trephine
