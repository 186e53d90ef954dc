// What a lens before a screen does to a picture, undone beforehand: pincushion by a barrel, and the
// colours' own sizes.
#pragma once

#include <array>
#include <filesystem>

#include "base/math.h"
#include "base/result.h"

namespace trephine {

// A point at the distance r from the lens's axis, in halves of the picture's height, is taken from
// r (1 + k1 r^2 + k2 r^4 + k3 r^6) of the picture, times the colour's own factor.
struct LensProfile {
  std::array<double, 3> k{};
  std::array<double, 3> colour{1.0, 1.0, 1.0};  // red, green, blue
  // Of the axis, from the middle of the left eye's picture to its right, in halves of its height;
  // the right eye's is mirrored.
  double axis = 0.0;
  friend bool operator==(const LensProfile&, const LensProfile&) = default;
};

// resources/schemas/lens.md. Errors: those of JSON files, BAD_LENS where it folds the picture over.
Result<LensProfile> readLensProfile(const std::filesystem::path& file);

// Where the shader takes a pixel of this eye from: both in halves of the height, from the middle.
glm::dvec2 lensSource(const LensProfile& lens, std::size_t eye, int colour, const glm::dvec2& at);

}  // namespace trephine
