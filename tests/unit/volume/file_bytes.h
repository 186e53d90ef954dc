// Files written byte by byte, without the product's writers.
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "volume/volume_files.h"

namespace trephine::test {

inline std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void writeBytes(const std::filesystem::path& file, const std::string& bytes) {
  std::filesystem::remove(file);  // some file systems flush a file that is cut and written anew
  std::ofstream(file, std::ios::binary) << bytes;
}

// "ok" or the error's code; every error says what, where and what next.
inline std::string codeOf(const std::filesystem::path& file) {
  const auto read = readVolumeFile(file);
  if (read) return "ok";
  EXPECT_FALSE(read.error().what.empty());
  EXPECT_EQ(read.error().where.rfind(file.parent_path().string(), 0), 0u) << "names the file";
  EXPECT_FALSE(read.error().next.empty());
  return read.error().code.str();
}

inline std::string sentenceOf(const std::filesystem::path& file) {
  const auto read = readVolumeFile(file);
  return read ? "ok" : read.error().sentence();
}

enum class Packing { none, gzip, zlib };

inline std::string packed(const std::string& bytes, Packing packing) {
  if (packing == Packing::none) return bytes;
  z_stream zlib{};
  EXPECT_EQ(
      deflateInit2(&zlib, 6, Z_DEFLATED, packing == Packing::gzip ? 31 : 15, 8, Z_DEFAULT_STRATEGY),
      Z_OK);
  std::string out(deflateBound(&zlib, uLong(bytes.size())) + 64, '\0');
  zlib.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  zlib.avail_in = uInt(bytes.size());
  zlib.next_out = reinterpret_cast<Bytef*>(out.data());
  zlib.avail_out = uInt(out.size());
  EXPECT_EQ(deflate(&zlib, Z_FINISH), Z_STREAM_END);
  out.resize(zlib.total_out);
  deflateEnd(&zlib);
  return out;
}

template <class T>
void append(std::string& bytes, T value, bool big_endian = false) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  if (big_endian) std::reverse(raw, raw + sizeof value);
  bytes.append(raw, sizeof value);
}

// The value as a file of that type stores it.
inline void appendAs(std::string& bytes, VoxelType type, double value, bool big_endian) {
  switch (type) {
    case VoxelType::int8:
      return append(bytes, std::int8_t(value), big_endian);
    case VoxelType::uint8:
      return append(bytes, std::uint8_t(value), big_endian);
    case VoxelType::int16:
      return append(bytes, std::int16_t(value), big_endian);
    case VoxelType::uint16:
      return append(bytes, std::uint16_t(value), big_endian);
    case VoxelType::int32:
      return append(bytes, std::int32_t(value), big_endian);
    case VoxelType::uint32:
      return append(bytes, std::uint32_t(value), big_endian);
    case VoxelType::int64:
      return append(bytes, std::int64_t(value), big_endian);
    case VoxelType::uint64:
      return append(bytes, std::uint64_t(value), big_endian);
    case VoxelType::float32:
      return append(bytes, float(value), big_endian);
    case VoxelType::float64:
      return append(bytes, value, big_endian);
  }
}

inline std::string voxelsAs(VoxelType type, const std::vector<double>& values,
                            bool big_endian = false) {
  std::string bytes;
  for (double value : values) appendAs(bytes, type, value, big_endian);
  return bytes;
}

inline std::string vectorText(const Vec3& v, const char* separator) {
  return std::to_string(v.x) + separator + std::to_string(v.y) + separator + std::to_string(v.z);
}

}  // namespace trephine::test
