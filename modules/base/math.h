// Vectors, rotations and poses. Frames and units: FRAMES.md.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace trephine {

using Vec3 = glm::dvec3;
using Quat = glm::dquat;  // (w, x, y, z), unit
using Mat3 = glm::dmat3;  // column-major: m[column][row]
using Mat4 = glm::dmat4;
using Index3 = std::array<std::int32_t, 3>;  // voxel index or size, (i, j, k), i fastest

// A rigid pose. The unit of `position` stands in the name of the variable that holds it.
struct Pose {
  Vec3 position{0.0};
  Quat orientation{1.0, 0.0, 0.0, 0.0};
};

inline bool isFinite(double v) { return std::isfinite(v); }
inline bool isFinite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
inline bool isFinite(const Quat& q) {
  return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z);
}
inline bool isFinite(const Pose& p) { return isFinite(p.position) && isFinite(p.orientation); }

}  // namespace trephine
