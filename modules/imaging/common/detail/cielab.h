// Colours as DICOM recommends them for display: CIELab of the ICC's connection space (D50) in 16
// bits each (PS3.3 C.10.7.1.1). Pure.
#pragma once

#include <array>
#include <cstdint>

#include "base/math.h"

namespace trephine {

// L* of 0 to 100, a* and b* of -128 to 127, each over 0 to 65535.
using LabWords = std::array<std::uint16_t, 3>;

// r, g, b in [0, 1] of sRGB.
LabWords labOf(const Vec3& srgb);
// A colour that no screen shows goes to the nearest r, g and b.
Vec3 srgbOf(const LabWords& lab);

}  // namespace trephine
