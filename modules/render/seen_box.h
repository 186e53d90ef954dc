// Where in a volume there is something to be seen. Pure.
#pragma once

#include "tissue/tissue_set.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

// The smallest box of voxels around what tissues with an opacity over 0 show, to within the
// step at which it looks (1 voxel in small volumes, 8 in the largest); single voxels in their
// slice, as noise has them, do not count. All of the volume where nothing is seen. `labels`: of the
// same voxels, may be null. Takes some 10 ms.
VoxelBox seenBox(const Volume& volume, const LabelMap* labels, const TissueSet& tissues);

}  // namespace trephine
