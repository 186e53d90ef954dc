// A volume made smaller: a part of it, or fewer and larger voxels, with what that costs in numbers.
// Pure functions; two threads inside.
#pragma once

#include <cstdint>

#include "base/result.h"
#include "volume/volume.h"

namespace trephine {

// The voxels in the box; each keeps its place in the patient. Errors: BAD_CROP (nothing in it, or
// not wholly inside the volume), OUT_OF_MEMORY.
Result<Volume> crop(const Volume& volume, const VoxelBox& box);
// The same within the memory that `volume` has; what the box leaves free goes back to the system.
// After an error `volume` is as it was.
Result<Volume> crop(Volume&& volume, const VoxelBox& box);

// Each voxel the mean of factor^3 (2 or 4), rounded to the nearest, halves to even; at the far
// faces the mean of those there are, so that no air is mixed in. Voxel (0, 0, 0) lies at the middle
// of the first whole block, spacing grows by the factor. Needs the memory of the result. Errors:
// BAD_FACTOR, BAD_SIZE, OUT_OF_MEMORY.
Result<Volume> reduced(const Volume& volume, int factor);

// Size and spacing of what the two leave of `grid`; origin and direction stay those of `grid`.
GridGeometry outcomeOf(const GridGeometry& grid, const VoxelBox& box, int factor);

// What `reduced` lost: the reduced volume, read back trilinearly at the original's voxels, against
// those voxels. Up to four million are asked, every `stride`-th along i, j and k; strides are odd,
// so that all places within a block are met alike, and grow in turn, i first.
struct ReductionLoss {
  Index3 stride{1, 1, 1};
  std::uint64_t samples = 0;
  double rms_hu = 0.0;
  double p99_hu = 0.0;  // 99 of 100 differ by at most this (to 1 HU)
  // Bone is what lies over 300 HU. Both are 0 where the original has none.
  double bone_volume_change_percent = 0.0;  // of its volume: thick bone grows where thin bone goes
  double bone_lost_percent = 0.0;           // of its voxels, those that are bone no more
};

constexpr double kBoneHu = 300.0;

// `small` is reduced(original, factor). Takes well under a second at any size.
ReductionLoss reductionLoss(const Volume& original, const Volume& small, int factor);

}  // namespace trephine
