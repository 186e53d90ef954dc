// How a scanner would see a truth: the voxels of a phantom.
#pragma once

#include <cstdint>
#include <vector>

#include "volume/phantom.h"

namespace trephine {

// The truth at every voxel's centre, i fastest, on two threads.
std::vector<PhantomTissue> truthAtCentres(PhantomTruth truth, const GridGeometry& geometry);

// Fills volume.hu with the truth seen through a scanner's point spread (phantom.h), in eighths of
// HU and without noise. Works slice after slice in a few slices' memory, on two threads, and in
// whole numbers: the same bits everywhere.
void paintPhantom(PhantomTruth truth, const std::vector<PhantomTissue>& centres, Volume& volume);

}  // namespace trephine
