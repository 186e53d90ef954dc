// The skin of a CT, without a click: the outermost layer of the body, where it meets the air around
// it. By HU and shape alone.
//
// 1. The body: the largest piece over kBody_HU, across faces. A table or blanket with air between
// is
//    a piece of its own; one that the body lies on is not, and is to be taken out on import.
// 2. The air around it: where a ball of kOpening_mm fits that comes from the sides of the scan, in
//    blocks of about 2 mm, and what lies within kInto_mm of such blocks. So nostrils, ears and the
//    lips are entered by some millimetres, and what lies behind them is not.
// 3. Of the body, what lies within the thickness of that air, and at least the voxels that touch
// it,
//    so that no ray passes. The scan's ends, along the body, are no surface.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

constexpr double kBody_HU = -300.0;  // half-way from skin to air, roughly
constexpr double kOpening_mm = 4.0;  // radius
constexpr double kInto_mm = 8.0;
constexpr double kLeastBody_ml = 50.0;

struct Skin {
  LabelMap mask;  // 0 and 1, on the volume's grid
  std::size_t voxels = 0;
  double ml = 0.0;
  std::vector<std::string> steps;  // what was done, in words
};

// `thickness_mm` from 0.1 to 20. Two threads inside; takes a byte a voxel beside the volume, and 12
// a run of voxels. Errors: BAD_ARGUMENT, NO_BODY (no piece of kLeastBody_ml, or no air at the sides
// of the scan), CANCELLED, OUT_OF_MEMORY.
Result<Skin> skinOf(const Volume& volume, double thickness_mm = 2.0,
                    const Progress& progress = Progress());

}  // namespace trephine
