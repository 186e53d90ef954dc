// A plane that cuts the picture. Patient frame.
#pragma once

#include "base/math.h"

namespace trephine {

// What lies on the side that the normal points to is not drawn.
struct ClipPlane {
  Vec3 point_mm{0.0};
  Vec3 normal{0.0, 0.0, 1.0};
  friend bool operator==(const ClipPlane&, const ClipPlane&) = default;
};

}  // namespace trephine
