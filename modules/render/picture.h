#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/result.h"

namespace trephine {

// 8-bit RGB, rows from the top.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
  friend bool operator==(const Picture&, const Picture&) = default;
};

// Peak signal-to-noise ratio of `b` against `a` in dB; infinity where they are equal.
double psnr_dB(const Picture& a, const Picture& b);

// The file is whole or not touched. Errors: BAD_PICTURE, WRITE_FAILED, CANNOT_WRITE.
Status writePng(const Picture& picture, const std::filesystem::path& file);

}  // namespace trephine
