// How a scanner would see a truth: the voxels of a phantom.
#pragma once

#include <cstdint>
#include <vector>

#include "base/progress.h"
#include "volume/phantom.h"

namespace trephine {

// The truth at every voxel's centre, i fastest, on two threads. Empty where it was cancelled.
std::vector<PhantomTissue> truthAtCentres(PhantomTruth truth, const GridGeometry& geometry,
                                          const Progress& progress);

// Fills volume.hu with the truth seen through a scanner's point spread (phantom.h), and noise.
// Works slice after slice in a few slices' memory, on two threads, and in whole numbers: the same
// bits everywhere. False when cancelled.
bool paintPhantom(PhantomTruth truth, const std::vector<PhantomTissue>& centres, double noise_hu,
                  const Progress& progress, Volume& volume);

}  // namespace trephine
