// Whether two grids lie at one place. Pure.
#pragma once

#include <array>

#include "volume/volume.h"

namespace trephine {

// The eight corner voxels, as indices (i, j, k); i changes first.
std::array<Vec3, 8> cornerVoxels(const GridGeometry& grid);

// The farthest that a corner voxel of the one lies from that of the other [mm]. Infinite where
// their sizes differ, and where it is no number.
double cornersApart_mm(const GridGeometry& a, const GridGeometry& b);

// The farthest that a corner voxel of the one lies from the nearest of the other, in whatever order
// they count their voxels [mm]: of two that are 0 apart, voxels of one index may lie elsewhere.
// Infinite where their sizes are not the same three.
double cornersFrom_mm(const GridGeometry& of, const GridGeometry& other);

}  // namespace trephine
