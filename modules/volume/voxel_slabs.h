// Voxels that are read a slab at a time, so that saving and hashing need no further copy of them
// all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "volume/grid.h"
#include "volume/volume.h"

namespace trephine {

// What they are read from outlives them, and nobody writes it meanwhile.
struct VoxelSlabs {
  GridGeometry geometry;
  // The voxels from `first` on, as many as fit; all of them lie in the grid.
  std::function<void(std::size_t first, std::span<std::int16_t> into)> read;

  static constexpr std::size_t kMostVoxels = (std::size_t(16) << 20) / sizeof(std::int16_t);
  // All voxels in order, at most 16 MB or `most` voxels at a time, until `take` answers false.
  // Allocates one slab. False where it was told so.
  bool forEach(const std::function<bool(std::span<const std::int16_t>)>& take,
               std::size_t most = kMostVoxels) const;
};

VoxelSlabs slabsOf(const Volume& volume);
VoxelSlabs slabsOf(const Grid& grid);
// The same with its slices in the opposite order, each voxel where it was in the patient.
VoxelSlabs reversedSlices(VoxelSlabs slabs);

// As volumeSha256().
std::string slabsSha256(const VoxelSlabs& slabs);

}  // namespace trephine
