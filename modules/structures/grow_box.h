// The box that growing keeps to, as a person draws it in slices. Pure.
#pragma once

#include <optional>

#include "volume/volume.h"

namespace trephine {

bool holds(const VoxelBox& box, const Index3& voxel);

// The box with other sides along two axes of the grid: those of a slice, which lies across
// `across`. They hold the voxels between two corners, in the patient's LPS frame, as far as the
// grid goes. Nothing where that is no voxel.
std::optional<VoxelBox> withSides(const VoxelBox& box, const GridGeometry& grid,
                                  const Vec3& from_mm, const Vec3& to_mm, int across);

// Along the grid's axes.
Vec3 size_mm(const VoxelBox& box, const GridGeometry& grid);

}  // namespace trephine
