// The motion that is nearest to a wanted one and enters nothing.
#pragma once

#include <array>
#include <span>

#include "base/math.h"

namespace trephine {

// A small motion of a rigid body.
struct SmallMotion {
  Vec3 shift_mm{0.0};
  Vec3 turn{0.0};  // 2 sin(angle / 2) along its axis
};

// The turn from one orientation to another.
inline Vec3 smallTurn(const Quat& from, const Quat& to) {
  const Quat by = to * glm::conjugate(from);
  return (by.w < 0.0 ? -2.0 : 2.0) * Vec3(by.x, by.y, by.z);
}

// Where a body is near something: a motion opens the gap by normal . shift + moment . turn.
struct NearTouch {
  Vec3 normal{0.0}, moment{0.0};  // moment: lever x normal, mm
  double gap_mm = 0.0;
  double load =
      0.0;  // out: the multiplier of this gap in the nearest motion, mm; 0 where it is open
};

// The motion nearest to `wanted` (|shift|^2 + turn_mm2 |turn|^2 apart) that leaves every gap at 0
// or above, by the dual method of Goldfarb and Idnani (Mathematical Programming 27, 1983). Touches
// that contradict others are left out. At most kMostTouches. No allocation.
constexpr std::size_t kMostTouches = 64;
SmallMotion nearestMotion(const SmallMotion& wanted, double turn_mm2, std::span<NearTouch> touches);

}  // namespace trephine
