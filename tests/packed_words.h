// Words in files, however these are packed: as bytes, as UTF-16, and in what a file compresses
// (gzip, zlib, zip; so also PNG texts, chunks of HDF5 and streams of PDF). Link ZLIB::ZLIB.
#pragma once

#include <zlib.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace trephine::test {

// What one deflate stream at the beginning of `bytes` holds, as far as it can be read; `used`: how
// long it is, 0 where it does not come to its end. Bits as of inflateInit2.
inline std::string inflated(std::string_view bytes, int bits, std::size_t& used) {
  std::string out;
  z_stream stream{};
  used = 0;
  if (inflateInit2(&stream, bits) != Z_OK) return out;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = uInt(bytes.size());
  std::array<char, 1 << 16> piece;
  int state = Z_OK;
  while (state == Z_OK && out.size() < (std::size_t(1) << 28)) {
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = uInt(piece.size());
    state = inflate(&stream, Z_NO_FLUSH);
    out.append(piece.data(), piece.size() - stream.avail_out);
  }
  if (state == Z_STREAM_END) used = bytes.size() - stream.avail_in;
  inflateEnd(&stream);
  return out;
}

inline std::string unpacked(std::string_view bytes) {
  std::string all;
  for (std::size_t i = 0; i + 2 < bytes.size(); ++i) {
    const auto at = [&](std::size_t n) {
      return i + n < bytes.size() ? std::uint8_t(bytes[i + n]) : 0;
    };
    const bool gzip = at(0) == 0x1f && at(1) == 0x8b && at(2) == 8;
    const bool zlib = (at(0) & 15) == 8 && at(0) < 0x80 && (at(0) * 256 + at(1)) % 31 == 0;
    const bool zip = bytes.substr(i, 4) == "PK\x03\x04";
    if (!gzip && !zlib && !zip) continue;
    const std::size_t from = zip ? i + 30 + at(26) + 256u * at(27) + at(28) + 256u * at(29) : i;
    if (from >= bytes.size()) continue;
    std::size_t used = 0;
    all += inflated(bytes.substr(from), gzip ? 31 : zlib ? 15 : -15, used);
    all += '\n';
    if (used > 0) i = from + used - 1;
  }
  return all;
}

inline std::string upperCase(std::string text) {
  for (char& c : text) c = c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
  return text;
}

inline std::string bytesOfFile(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// The first of the words that stands in these bytes, in letters of either case; empty: none. Words
// of less than 5 letters count in text alone: among voxels they come up by chance.
inline std::string wordIn(const std::string& bytes, const std::vector<std::string>& words) {
  const bool text = bytes.find('\0') == bytes.npos;
  std::string packed = unpacked(bytes);
  const std::array<std::string, 2> places{upperCase(bytes), upperCase(std::move(packed))};
  for (const std::string& word : words) {
    const std::string upper = upperCase(word);
    std::string little, big;
    for (const char c : upper) {
      little += {c, '\0'};
      big += {'\0', c};
    }
    for (const std::string& place : places) {
      const bool here = place.find(upper) != place.npos;
      if (here && (upper.size() >= 5 || (text && &place == &places[0]))) return word;
      if (upper.size() < 5) continue;
      if (place.find(little) != place.npos || place.find(big) != place.npos) return word;
    }
  }
  return {};
}

// How often, in bytes and in what they pack.
inline int countIn(const std::string& bytes, const std::string& word) {
  int count = 0;
  for (const std::string& place : {bytes, unpacked(bytes)}) {
    for (auto at = place.find(word); at != place.npos; at = place.find(word, at + 1)) ++count;
  }
  return count;
}

}  // namespace trephine::test
