// A structure that is known in blocks (work_grid.h), at the CT's own voxels: its border lies where
// HU are half-way to what lies beyond, which is where a scanner's blur leaves it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "structures/work_grid.h"
#include "volume/volume.h"

namespace trephine {

// 0 or 1 a voxel. Blocks whose neighbours are all in stay as they are; `hu` is the structure's, for
// the others; nothing outside of `box`. Two threads; 9 bits a voxel. std::bad_alloc where there
// is no memory.
std::vector<std::uint8_t> voxelsOf(const BlockMask& in, const WorkGrid& grid, const Volume& volume,
                                   const HuSpan& hu, const std::optional<VoxelBox>& box);

}  // namespace trephine
