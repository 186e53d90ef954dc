// Slices that lie far apart, and volumes with slices between them.
#pragma once

#include "base/result.h"
#include "volume/volume.h"

namespace trephine {

// Beyond this slices are thick for touch: a tool meets voxels whole, so that on slices 3 mm apart a
// thin blade takes up to 2.6 times what it sweeps, and on 5 mm a burr a third of it or a half more.
constexpr double kThickSlices_mm = 2.5;

// Into how many equal steps each step between two slices is to be divided, so that they lie no
// farther apart than 1 mm, or than a slice's own pixels where these are larger; 1: the slices are
// no more than kThickSlices_mm apart, or not 1.5 times as far as the pixels.
int stepsBetweenSlices(const GridGeometry& geometry);

// The geometry of a volume with each step between two slices divided into so many.
GridGeometry withThinSlices(GridGeometry geometry, int steps);
// The volume: its own slices, and between each two of them those by linear interpolation, rounded
// to the nearest. `steps` from 2 on. Needs the memory of the result. Errors: BAD_SIZE,
// OUT_OF_MEMORY.
Result<Volume> withThinSlices(const Volume& volume, int steps);

}  // namespace trephine
