#include "structures/grow_box.h"

#include <algorithm>
#include <cmath>

namespace trephine {

bool holds(const VoxelBox& box, const Index3& voxel) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (voxel[axis] < box.low[axis] || voxel[axis] >= box.high[axis]) return false;
  }
  return true;
}

std::optional<VoxelBox> withSides(const VoxelBox& box, const GridGeometry& grid,
                                  const Vec3& from_mm, const Vec3& to_mm, int across) {
  const Mat4 to_voxel = grid.patientToVoxel();
  const Vec3 from(to_voxel * glm::dvec4(from_mm, 1.0)), to(to_voxel * glm::dvec4(to_mm, 1.0));
  VoxelBox wanted = box;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == across) continue;
    const auto a = std::size_t(axis);
    const double last = grid.size[a];
    wanted.low[a] = int(std::clamp(std::ceil(std::min(from[axis], to[axis])), 0.0, last));
    wanted.high[a] = int(std::clamp(std::floor(std::max(from[axis], to[axis])) + 1.0, 0.0, last));
    if (wanted.low[a] >= wanted.high[a]) return std::nullopt;
  }
  return wanted;
}

Vec3 size_mm(const VoxelBox& box, const GridGeometry& grid) {
  Vec3 mm = grid.spacing_mm;
  for (int axis = 0; axis < 3; ++axis) {
    mm[axis] *= box.high[std::size_t(axis)] - box.low[std::size_t(axis)];
  }
  return mm;
}

}  // namespace trephine
