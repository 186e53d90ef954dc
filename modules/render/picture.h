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

// Structural similarity of the luminance (Wang et al. 2004: Gaussian windows of 1.5 pixels, 11
// wide; C1 = (0.01 * 255)^2, C2 = (0.03 * 255)^2), the mean over all windows that lie in the
// picture. 1 for equal pictures; 0 for pictures of other sizes, or of fewer than 11 pixels along an
// edge.
double ssim(const Picture& a, const Picture& b);

// The file is whole or not touched. Errors: BAD_PICTURE, WRITE_FAILED, CANNOT_WRITE.
Status writePng(const Picture& picture, const std::filesystem::path& file);

}  // namespace trephine
