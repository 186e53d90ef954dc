#include "volume/voxel_reader.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "base/codes.h"
#include "base/memory.h"
#include "base/tr.h"
#include "volume/case_memory.h"
#include "volume/file_format.h"

namespace trephine::file_format {

namespace {

Error cancelled(const std::filesystem::path& file) {
  return {code::kCancelled, tr("Reading the volume was cancelled"), file.string(), ""};
}

constexpr double kWhole = 1e-4;  // from a whole number
// Between two such parts it is asked whether reading was cancelled: 0.1 s of a stick of 5 MB/s.
constexpr std::size_t kVoxelsAtOnce = std::size_t{1} << 16;

// The bytes of the voxels, one after another. Packed ones in zlib's or gzip's format, of gzip also
// several streams one after another, as compressors with threads write them.
class VoxelBytes {
 public:
  VoxelBytes(const std::filesystem::path& file, std::uint64_t offset, std::uint64_t bytes,
             bool packed)
      : in_(file, std::ios::binary), left_(bytes), packed_(packed) {
    in_.seekg(std::streamoff(offset));
    // 15: the largest window; 32: either format, by its first bytes.
    if (packed_ && inflateInit2(&zlib_, 15 + 32) != Z_OK) throw std::bad_alloc();
  }
  ~VoxelBytes() {
    if (packed_) inflateEnd(&zlib_);
  }
  VoxelBytes(const VoxelBytes&) = delete;
  VoxelBytes& operator=(const VoxelBytes&) = delete;

  // As many as there are before the file ends or what is packed is damaged.
  std::size_t readSome(std::uint8_t* to, std::size_t count) {
    if (!packed_) {
      in_.read(reinterpret_cast<char*>(to), std::streamsize(count));
      return std::size_t(in_.gcount());
    }
    zlib_.next_out = to;
    zlib_.avail_out = uInt(count);
    while (zlib_.avail_out > 0) {
      if (ended_ && inflateReset(&zlib_) != Z_OK) break;
      if (!step()) break;
    }
    return count - zlib_.avail_out;
  }
  bool read(std::uint8_t* to, std::size_t count) { return readSome(to, count) == count; }

  // Until it is cancelled.
  bool skip(std::uint64_t count, const Progress& progress) {
    constexpr std::uint64_t kAtOnce = std::uint64_t{1} << 20;
    std::vector<std::uint8_t> unused(std::size_t(std::min(count, kAtOnce)));
    while (count > 0 && !progress.cancelled()) {
      const std::uint64_t now = std::min<std::uint64_t>(count, unused.size());
      if (!read(unused.data(), std::size_t(now))) return false;
      count -= now;
    }
    return count == 0;
  }

  // What follows the last voxel of packed ones. Bytes behind the end that are not packed are passed
  // over, as gzip does.
  enum class End { reached, longer, damaged };
  End end() {
    std::uint8_t unused[4096];
    while (packed_) {
      zlib_.next_out = unused;
      zlib_.avail_out = sizeof unused;
      const bool another = ended_;
      if (another && inflateReset(&zlib_) != Z_OK) return End::reached;
      if (!step()) return another ? End::reached : End::damaged;
      if (zlib_.avail_out < sizeof unused) return End::longer;
    }
    return End::reached;
  }

 private:
  bool step() {
    if (zlib_.avail_in == 0) {
      in_.read(reinterpret_cast<char*>(buffer_),
               std::streamsize(std::min<std::uint64_t>(left_, sizeof buffer_)));
      zlib_.next_in = buffer_;
      zlib_.avail_in = uInt(in_.gcount());
      left_ -= zlib_.avail_in;
      if (zlib_.avail_in == 0) return false;
    }
    const int result = inflate(&zlib_, Z_NO_FLUSH);
    ended_ = result == Z_STREAM_END;
    return ended_ || result == Z_OK;
  }

  std::ifstream in_;
  std::uint64_t left_;
  bool packed_;
  bool ended_ = false;
  z_stream zlib_{};
  std::uint8_t buffer_[1 << 16];
};

void swapBytes(std::vector<std::uint8_t>& bytes, std::size_t size) {
  for (std::size_t at = 0; at < bytes.size(); at += size) {
    std::reverse(bytes.data() + at, bytes.data() + at + size);
  }
}

// Whether words of two bytes have them in the other order: then most neighbours differ far less
// once they are exchanged.
class ByteOrder {
 public:
  // Looks at some of `bytes`, neighbours one after another.
  void add(const std::vector<std::uint8_t>& bytes) {
    constexpr int kFar = 2;
    constexpr std::uint32_t kFactor = 1664525, kTerm = 1013904223;  // of a common generator
    constexpr std::size_t kSmall = 16384;                           // all of them, then
    const std::size_t words = bytes.size() / 2;
    for (std::size_t n = 1; n < words; n += words < kSmall ? 1 : 1 + (state_ >> 26)) {
      state_ = state_ * kFactor + kTerm;
      const std::uint8_t* at = bytes.data() + 2 * n;
      const int as_they_are = std::abs(word(at[0], at[1]) - word(at[-2], at[-1]));
      const int exchanged = std::abs(word(at[1], at[0]) - word(at[-1], at[-2]));
      wrong_ += as_they_are > kFar * exchanged;
      right_ += exchanged > kFar * as_they_are;
    }
  }
  bool isWrong() const {
    constexpr std::int64_t kEnough = 32, kMost = 4;
    return wrong_ >= kEnough && wrong_ > kMost * right_;
  }

 private:
  static int word(std::uint8_t low, std::uint8_t high) {
    return std::int16_t(std::uint16_t(low | (high << 8)));
  }
  std::uint32_t state_ = 1;
  std::int64_t wrong_ = 0, right_ = 0;  // pairs that say so
};

template <class Stored>
void convert(const std::vector<std::uint8_t>& from, std::int16_t* to, VolumeFileReading& reading) {
  const double slope = reading.header.slope, intercept = reading.header.intercept;
  for (std::size_t at = 0; at < from.size(); at += sizeof(Stored), ++to) {
    Stored stored;
    std::memcpy(&stored, from.data() + at, sizeof stored);
    const double value = double(stored) * slope + intercept;
    if (!std::isfinite(value)) {
      *to = kAirHu;
      ++reading.not_numbers;
      continue;
    }
    reading.hu_min = std::min(reading.hu_min, value);
    reading.hu_max = std::max(reading.hu_max, value);
    const double whole = std::floor(value + 0.5);
    const double hu = std::clamp(whole, -32768.0, 32767.0);
    reading.clamped += hu != whole;
    // A slope or a float leaves 5.0000003 of a 5.
    reading.rounded += hu == whole && std::abs(hu - value) > kWhole;
    *to = std::int16_t(hu);
  }
}

using Convert = void (*)(const std::vector<std::uint8_t>&, std::int16_t*, VolumeFileReading&);
struct TypeRow {
  const char* name;
  int bytes;
  Convert convert;
};
// In the order of VoxelType.
constexpr TypeRow kTypes[] = {
    {"int8", 1, convert<std::int8_t>},   {"uint8", 1, convert<std::uint8_t>},
    {"int16", 2, convert<std::int16_t>}, {"uint16", 2, convert<std::uint16_t>},
    {"int32", 4, convert<std::int32_t>}, {"uint32", 4, convert<std::uint32_t>},
    {"int64", 8, convert<std::int64_t>}, {"uint64", 8, convert<std::uint64_t>},
    {"float32", 4, convert<float>},      {"float64", 8, convert<double>}};

const TypeRow& rowOf(VoxelType type) {
  return kTypes[std::size_t(type)];
}

}  // namespace

std::string unpackedStart(const std::filesystem::path& file, bool packed, std::size_t most) {
  std::string start(most, '\0');
  VoxelBytes source(file, 0, std::numeric_limits<std::uint64_t>::max(), packed);
  start.resize(source.readSome(reinterpret_cast<std::uint8_t*>(start.data()), most));
  return start;
}

Result<VolumeFileReading> readVoxels(VolumeFileHeader header, const std::filesystem::path& file,
                                     const Progress& progress) {
  const std::size_t count = header.geometry.voxelCount();
  const auto& [name, voxel_bytes, convertVoxels] = rowOf(header.type);
  if (Status enough = enoughToRead(voxelsMb(count), tr("Reading the volume"), file.string());
      !enough) {
    return enough.error();
  }
  VolumeFileReading reading{std::move(header), {}};
  reading.hu_min = std::numeric_limits<double>::infinity();
  reading.hu_max = -reading.hu_min;
  const VolumeFileHeader& h = reading.header;
  VoxelBytes source(h.data.file, h.data.offset, h.data.bytes, h.data.packed);
  Voxels& hu = reading.volume.hu;
  // Memory is reserved here but only filled, and so taken, as voxels come.
  hu.reserve(count);
  ByteOrder order;
  bool whole = source.skip(h.data.skip, progress);
  for (std::vector<std::uint8_t> bytes; whole && hu.size() < count;) {
    if (progress.cancelled()) return cancelled(file);
    progress.at(double(hu.size()) / double(count), tr("Reading voxels"));
    const std::size_t done = hu.size(), now = std::min(kVoxelsAtOnce, count - done);
    bytes.resize(now * std::size_t(voxel_bytes));
    whole = source.read(bytes.data(), bytes.size());
    if (h.big_endian) swapBytes(bytes, std::size_t(voxel_bytes));
    if (voxel_bytes == 2) order.add(bytes);
    hu.resize(done + now);
    if (whole) convertVoxels(bytes, hu.data() + done, reading);
  }
  if (progress.cancelled()) return cancelled(file);
  const VoxelBytes::End end = whole ? source.end() : VoxelBytes::End::damaged;
  if (end == VoxelBytes::End::damaged) {
    return unreadable(tr("The file's voxels are damaged or cut short"), file);
  }
  if (end == VoxelBytes::End::longer) return longerThanSaid(h, "", file);
  reading.bytes_exchanged = order.isWrong();
  if (reading.not_numbers == count) return notHu(tr("No voxel of the image is a number"), file);
  if (reading.clamped > count / 2) {
    return notHu(tr("The image holds values that are not HU: most of them need over 16 bits"),
                 file);
  }
  reading.volume.geometry = h.geometry;
  if (h.reversed_slices) reverseSlices(reading.volume);
  progress.at(1.0, tr("Reading voxels"));
  return reading;
}

}  // namespace trephine::file_format

namespace trephine {

const char* voxelTypeName(VoxelType type) {
  return file_format::rowOf(type).name;
}

int bytesOf(VoxelType type) {
  return file_format::rowOf(type).bytes;
}

}  // namespace trephine
