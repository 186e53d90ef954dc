// Contact by HU look-up: which of a tool's points lie in tissue.
#pragma once

#include <cstdint>
#include <vector>

#include "base/math.h"
#include "haptics/tool.h"
#include "tissue/tissue_set.h"
#include "volume/grid.h"

namespace trephine {

struct Hit {
  std::size_t voxel;
  std::int32_t tissue_class;
};

struct Contact {
  std::int32_t tissue_class = -1;  // the firmest tissue touched; -1 none
  std::int32_t points = 0;         // sample points in tissue
  bool touching() const { return tissue_class >= 0; }
};

// The nearest voxel to a patient position, or -1 outside the grid (which counts as air). Any value
// is answered, infinities and NaN too.
std::int64_t nearestVoxel(const GridGeometry& geometry, const Mat4& patient_to_voxel,
                          const Vec3& patient_mm);

// Looks up every sample point of `tool` at `pose_mm` and lists those in tissue in `hits`, which has
// room for all points. The firmest class is that of the largest yield force, then of the largest
// damping.
//
// A tool that erases what it touches would lose contact at once and find it again a voxel later, so
// contact once made (`before`) is held while tissue stands within `hold_mm` of any point along the
// patient's axes. Held contact has no hits.
Contact findContact(const Grid& grid, const Mat4& patient_to_voxel, const TissueTable& tissues,
                    const Tool& tool, const Pose& pose_mm, const Contact& before, double hold_mm,
                    std::vector<Hit>& hits);

}  // namespace trephine
