#include "volume/gzip_writer.h"

#include <zlib.h>

#include <algorithm>

#include "volume/two_threads.h"

namespace trephine::file_format {

namespace {

// Fastest. Of a CT, half of which is noise, the levels above gain under 3 % and take up to eight
// times as long (tests/bench/bench_nifti.cpp).
constexpr int kLevel = Z_BEST_SPEED;
constexpr int kRaw = -15;     // the largest window, without a header or checksum of its own
constexpr int kMemory = 8;    // zlib's usual
constexpr int kFlushed = 16;  // at most, for the empty block that ends a piece on a whole byte

// How many bytes they became; 0 for want of memory.
std::size_t pack(std::span<const std::byte> bytes, std::span<std::uint8_t> into) {
  z_stream zlib{};
  if (deflateInit2(&zlib, kLevel, Z_DEFLATED, kRaw, kMemory, Z_DEFAULT_STRATEGY) != Z_OK) return 0;
  zlib.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes.data()));
  zlib.avail_in = uInt(bytes.size());
  zlib.next_out = into.data();
  zlib.avail_out = uInt(into.size());
  const bool whole = deflate(&zlib, Z_SYNC_FLUSH) == Z_OK && zlib.avail_out > 0;
  const std::size_t size = into.size() - zlib.avail_out;
  deflateEnd(&zlib);
  return whole ? size : 0;
}

}  // namespace

bool GzipWriter::write(std::span<const std::byte> bytes) {
  // No name, no time: the same volume is the same file. 4: fastest; 3: Unix.
  constexpr std::uint8_t kHeader[] = {0x1f, 0x8b, Z_DEFLATED, 0, 0, 0, 0, 0, 4, 3};
  if (!begun_ && !put(kHeader, sizeof kHeader)) return false;
  begun_ = true;

  const auto part = [bytes](std::size_t n) {
    return bytes.subspan(n * kPiece, std::min(kPiece, bytes.size() - n * kPiece));
  };
  const std::size_t count = (bytes.size() + kPiece - 1) / kPiece;
  pieces_.resize(std::max(pieces_.size(), count));
  for (std::size_t n = 0; n < count; ++n) {
    pieces_[n].packed.resize(compressBound(uLong(part(n).size())) + kFlushed);
  }
  onTwoThreads(int(count), [&](int n) {
    const auto from = part(std::size_t(n));
    Piece& piece = pieces_[std::size_t(n)];
    piece.size = pack(from, piece.packed);
    piece.checksum =
        std::uint32_t(crc32(0, reinterpret_cast<const Bytef*>(from.data()), uInt(from.size())));
  });
  for (std::size_t n = 0; n < count; ++n) {
    const Piece& piece = pieces_[n];
    if (piece.size == 0 || !put(piece.packed.data(), piece.size)) return false;
    checksum_ = std::uint32_t(crc32_combine(checksum_, piece.checksum, z_off_t(part(n).size())));
    length_ += std::uint32_t(part(n).size());
  }
  return true;
}

bool GzipWriter::finish() {
  std::uint8_t end[10] = {3, 0};  // an empty block that says that it is the last
  for (int byte = 0; byte < 4; ++byte) {
    end[2 + byte] = std::uint8_t(checksum_ >> 8 * byte);
    end[6 + byte] = std::uint8_t(length_ >> 8 * byte);
  }
  return put(end, sizeof end);
}

bool GzipWriter::put(const void* from, std::size_t count) {
  return std::fwrite(from, 1, count, out_) == count;
}

}  // namespace trephine::file_format
