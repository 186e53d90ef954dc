// One gzip stream, packed on two threads. For this room's .cpp files only.
//
// One member and not one a thread: what unpacks in a browser refuses a second member, and some
// libraries give out the first alone and say nothing. So each piece is packed by itself, up to a
// whole byte, and the pieces stand one after another in the same stream. Its bytes do not depend on
// the threads, only on how the bytes are divided among the calls.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <vector>

namespace trephine::file_format {

class GzipWriter {
 public:
  static constexpr std::size_t kPiece = std::size_t(512) << 10;  // bytes, 8 ms of one core
  // To give at once: two threads have enough to share, and what they become takes as much memory.
  static constexpr std::size_t kAtOnce = 8 * kPiece;

  // `out` is open for writing and outlives this.
  explicit GzipWriter(std::FILE* out) : out_(out) {}

  // False, as for a full disk, where they could not be written.
  bool write(std::span<const std::byte> bytes);
  // After the last byte: the stream's end and its checksum.
  bool finish();

 private:
  bool put(const void* from, std::size_t count);

  struct Piece {
    std::vector<std::uint8_t> packed;  // as much as there might be
    std::size_t size = 0;              // what there is; 0 where it could not be packed
    std::uint32_t checksum = 0;
  };

  std::FILE* out_;
  std::vector<Piece> pieces_;  // kept from call to call for their memory
  bool begun_ = false;
  std::uint32_t checksum_ = 0;
  std::uint32_t length_ = 0;  // of all that was given, modulo 2^32 as gzip has it
};

}  // namespace trephine::file_format
