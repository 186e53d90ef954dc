#include "imaging/dicom/detail/dicom_pixels.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>

#include "base/descriptor.h"
#include "base/tr.h"
#include "imaging/common/workers.h"
#include "imaging/dicom/detail/codecs.h"
#include "imaging/dicom/detail/dicom_stream.h"
#include "imaging/dicom/detail/pixel_error.h"
#include "imaging/dicom/detail/transfer_syntax.h"

namespace trephine {

namespace {

constexpr std::size_t kMostFragments = 1000000;
constexpr std::uint32_t kPixelData = 0x7FE00010U, kUndefined = 0xFFFFFFFFU;
constexpr std::uint32_t kItem = 0xFFFEE000U, kSequenceEnd = 0xFFFEE0DDU;

class File {
 public:
  explicit File(const std::filesystem::path& path, const Progress* progress = nullptr)
      : file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)), progress_(progress) {}

  // All of it, or false; false as well once it is cancelled.
  bool read(std::uint64_t offset, void* to, std::size_t bytes) const {
    auto* at = static_cast<std::uint8_t*>(to);
    while (bytes > 0) {
      if (progress_ && progress_->cancelled()) return false;
      const std::size_t piece = std::min(bytes, kPieceBytes);
      const ssize_t count = ::pread(file_.get(), at, piece, off_t(offset));
      if (count <= 0) return false;
      at += count;
      offset += std::uint64_t(count);
      bytes -= std::size_t(count);
    }
    return true;
  }

 private:
  Descriptor file_;
  const Progress* progress_;
};

std::uint32_t number32(const std::uint8_t* bytes, bool big) {
  std::uint32_t value = 0;
  for (int n = 0; n < 4; ++n) value |= std::uint32_t(bytes[n]) << 8 * (big ? 3 - n : n);
  return value;
}

// Group and element, as one number.
std::uint32_t tagOf(const std::uint8_t* bytes, bool big) {
  const auto half = [&](int at) {
    return std::uint32_t(bytes[at + (big ? 0 : 1)]) << 8 | bytes[at + (big ? 1 : 0)];
  };
  return half(0) << 16 | half(2);
}

// The item headers of an encapsulated value (PS3.5 A.4), always little endian. False where the file
// ends first or something else than an item stands there.
bool walkItems(const File& file, std::uint64_t offset, std::uint64_t file_bytes,
               std::vector<std::uint32_t>& frame_offsets,
               std::vector<PixelPlace::Fragment>& fragments) {
  bool table = true;
  while (fragments.size() < kMostFragments) {
    std::uint8_t head[8];
    if (!file.read(offset, head, sizeof head)) return false;
    const std::uint32_t tag = tagOf(head, false), bytes = number32(head + 4, false);
    offset += sizeof head;
    if (tag == kSequenceEnd) return true;
    if (tag != kItem || bytes == kUndefined || bytes > file_bytes - offset) return false;
    if (table) {
      std::vector<std::uint8_t> raw(std::min<std::uint32_t>(bytes, 4 * kMostFragments));
      if (!file.read(offset, raw.data(), raw.size())) return false;
      for (std::size_t n = 0; n + 4 <= raw.size(); n += 4) {
        frame_offsets.push_back(number32(raw.data() + n, false));
      }
      table = false;
    } else {
      fragments.push_back({offset, bytes});
    }
    offset += bytes;
  }
  return false;
}

// Which fragments make up each frame; nothing where that cannot be told.
std::vector<std::vector<PixelPlace::Fragment>> groupFragments(
    const std::vector<PixelPlace::Fragment>& fragments, const std::vector<std::uint32_t>& offsets,
    std::size_t frames) {
  if (fragments.empty() || fragments.size() < frames) return {};
  if (frames == 1) return {fragments};
  std::vector<std::vector<PixelPlace::Fragment>> grouped;
  if (fragments.size() == frames) {
    for (const auto& fragment : fragments) grouped.push_back({fragment});
    return grouped;
  }
  if (offsets.size() != frames) return {};
  const std::uint64_t base = fragments.front().offset - 8;  // of the first fragment's item header
  std::size_t frame = 0;
  for (const auto& fragment : fragments) {
    if (frame < frames && fragment.offset - 8 - base == offsets[frame]) {
      grouped.emplace_back();
      ++frame;
    }
    if (grouped.empty()) return {};
    grouped.back().push_back(fragment);
  }
  if (grouped.size() != frames) return {};
  return grouped;
}

// The same where the file ends early: frames that are not whole have no fragments. Only the offset
// table tells.
std::vector<std::vector<PixelPlace::Fragment>> wholeFrames(
    const std::vector<PixelPlace::Fragment>& fragments, const std::vector<std::uint32_t>& offsets,
    std::size_t frames) {
  if (fragments.empty() || offsets.size() != frames) return {};
  const std::uint64_t base = fragments.front().offset - 8;
  std::vector<std::vector<PixelPlace::Fragment>> whole(frames);
  auto fragment = fragments.begin();
  for (std::size_t frame = 0; frame + 1 < frames; ++frame) {
    std::uint64_t end = base + offsets[frame];
    std::vector<PixelPlace::Fragment> own;
    while (fragment != fragments.end() && end < base + offsets[frame + 1]) {
      own.push_back(*fragment);
      end = fragment->offset + fragment->bytes;
      ++fragment;
    }
    if (end != base + offsets[frame + 1]) break;
    whole[frame] = std::move(own);
  }
  return whole;
}

}  // namespace

std::shared_ptr<const PixelPlace> findPixels(const std::filesystem::path& path,
                                             std::uint64_t file_bytes, std::uint64_t value_offset,
                                             const std::array<std::uint8_t, 12>& newest,
                                             bool explicit_vr, bool big_endian, int frames,
                                             std::string& vr, bool& cut) {
  const std::uint64_t head_bytes = explicit_vr ? 12 : 8;
  const std::uint8_t* head = newest.data() + (newest.size() - head_bytes);
  if (value_offset < head_bytes || tagOf(head, big_endian) != kPixelData) return nullptr;
  auto place = std::make_shared<PixelPlace>();
  place->offset = value_offset;
  vr = explicit_vr ? std::string(head + 4, head + 6) : "OW";
  const std::uint32_t bytes = number32(head + head_bytes - 4, big_endian);
  place->encapsulated = bytes == kUndefined;
  if (!place->encapsulated) {
    place->bytes = bytes;
    cut = value_offset + bytes > file_bytes;
    return place;
  }
  std::vector<std::uint32_t> frame_offsets;
  std::vector<PixelPlace::Fragment> fragments;
  cut = !walkItems(File(path), value_offset, file_bytes, frame_offsets, fragments);
  const auto count = std::size_t(frames);
  place->frames = cut ? wholeFrames(fragments, frame_offsets, count)
                      : groupFragments(fragments, frame_offsets, count);
  return place;
}

std::optional<std::vector<std::uint8_t>> readBytes(const std::filesystem::path& path,
                                                   std::uint64_t offset, std::uint64_t bytes) {
  const File file(path);
  std::vector<std::uint8_t> read(bytes);
  if (!file.read(offset, read.data(), bytes)) return std::nullopt;
  return read;
}

Result<std::shared_ptr<const PixelReader::Bytes>> PixelReader::inflated(const DicomHeader& header,
                                                                        std::uint64_t needed,
                                                                        bool keep) {
  const std::lock_guard lock(mutex_);  // a second reader of the file waits for the first
  if (const auto it = inflated_.find(header.file); it != inflated_.end()) return it->second;
  const std::shared_lock rule(unknownRule());
  DicomStream stream(header.file, bounds_, &progress_);
  DcmFileFormat dicom;
  dicom.transferInit();
  if (dicom.readUntilTag(stream, EXS_Unknown, EGL_noChange, kLongestValue, DCM_PixelData).bad()) {
    return unreadablePixels(tr("its file is cut short or damaged"));
  }
  const std::uint8_t* head = stream.newest().data();
  if (tagOf(head, false) != kPixelData || number32(head + 8, false) == kUndefined) {
    return unreadablePixels(tr("its pixels are not stored as its transfer syntax says"));
  }
  if (number32(head + 8, false) < needed) return unreadablePixels(tr("its pixels are cut short"));
  // Memory is taken as bytes come, not as the header promises.
  auto all = std::make_shared<Bytes>();
  while (all->size() < needed) {
    if (progress_.cancelled()) return unreadablePixels(tr("reading it was cancelled"));
    const std::size_t before = all->size();
    all->resize(before + std::min<std::uint64_t>(kPieceBytes, needed - before));
    const offile_off_t count =
        stream.read(all->data() + before, offile_off_t(all->size() - before));
    if (count <= 0) return unreadablePixels(tr("its pixels are cut short"));
    all->resize(before + std::size_t(count));
  }
  if (keep) inflated_[header.file] = all;
  return std::shared_ptr<const Bytes>(all);
}

Status PixelReader::read(const DicomHeader& header, std::uint64_t from, std::uint64_t bytes,
                         std::uint8_t* to) {
  const TransferSyntax* syntax = findTransferSyntax(header.transfer_syntax);
  if (!syntax || !header.pixels) return unreadablePixels(tr("its transfer syntax cannot be read"));
  if (header.pixels->encapsulated || from + bytes > header.pixels->bytes) {
    return unreadablePixels(tr("its pixels are not stored as its header says"));
  }
  if (syntax->codec == Codec::deflated) {
    const auto all = inflated(header, header.pixels->bytes, true);
    if (!all) return all.error();
    std::memcpy(to, (*all)->data() + from, bytes);
  } else if (!File(header.file, &progress_).read(header.pixels->offset + from, to, bytes)) {
    return unreadablePixels(tr("its file vanished, changed or is cut short"));
  }
  return {};
}

Status PixelReader::read(const DicomHeader& header, std::int16_t* words) {
  const TransferSyntax* syntax = findTransferSyntax(header.transfer_syntax);
  if (!syntax || !header.pixels) return unreadablePixels(tr("its transfer syntax cannot be read"));
  if (!header.holdsGreyWords())
    return unreadablePixels(tr("its pixels are not one grey value each"));
  const std::uint64_t bytes = header.frameBytes();
  const std::uint64_t skipped = bytes * std::uint64_t(header.frame);
  const bool narrow = header.bits_allocated == 8;

  if (syntax->codec == Codec::dcmtk || syntax->codec == Codec::jpeg2000) {
    if (std::size_t(header.frame) >= header.pixels->frames.size()) {
      return unreadablePixels(tr("its frame is not in the file"));
    }
    const File file(header.file, &progress_);
    std::vector<std::uint8_t> codestream;
    for (const auto& fragment : header.pixels->frames[std::size_t(header.frame)]) {
      const std::size_t before = codestream.size();
      codestream.resize(before + fragment.bytes);
      if (!file.read(fragment.offset, codestream.data() + before, fragment.bytes)) {
        return unreadablePixels(tr("its file vanished, changed or is cut short"));
      }
    }
    return decodeFrame(*syntax, codestream, header, words);
  }

  if (header.swapped_pairs) {
    const std::uint64_t first = skipped & ~std::uint64_t(1);
    const auto pairs = readBytes(header.file, header.pixels->offset + first,
                                 ((skipped + bytes + 1) & ~std::uint64_t(1)) - first);
    if (!pairs) return unreadablePixels(tr("its file vanished, changed or is cut short"));
    for (std::uint64_t n = 0; n < bytes; ++n) words[n] = (*pairs)[((skipped + n) ^ 1) - first];
    return {};
  }
  // 8-bit pixels go to the upper half of the words' memory and are widened from there.
  auto* to = reinterpret_cast<std::uint8_t*>(words) + (narrow ? bytes : 0);
  if (syntax->codec == Codec::deflated) {
    const std::uint64_t needed = bytes * std::uint64_t(header.frames);
    const auto all = inflated(header, needed, header.frames > 1);
    if (!all) return all.error();
    if ((*all)->size() < skipped + bytes) return unreadablePixels(tr("its pixels are cut short"));
    std::memcpy(to, (*all)->data() + skipped, bytes);
  } else if (!File(header.file, &progress_).read(header.pixels->offset + skipped, to, bytes)) {
    return unreadablePixels(tr("its file vanished, changed or is cut short"));
  }
  if (narrow) {
    for (std::uint64_t n = 0; n < bytes; ++n) words[n] = to[n];
  } else if (header.big_endian) {
    for (std::uint64_t n = 0; n < bytes / 2; ++n) {
      const auto word = static_cast<std::uint16_t>(words[n]);
      words[n] = static_cast<std::int16_t>(std::uint16_t(word << 8 | word >> 8));
    }
  }
  return {};
}

}  // namespace trephine
