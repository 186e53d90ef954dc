// Whether two grids lie at one place. Pure.
#pragma once

#include "volume/volume.h"

namespace trephine {

// The farthest that a corner voxel of the one lies from that of the other [mm]. Infinite where
// their sizes differ, and where it is no number.
double cornersApart_mm(const GridGeometry& a, const GridGeometry& b);

}  // namespace trephine
