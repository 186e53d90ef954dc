// Where the surface of solid tissue stands at a voxel on it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "haptics/tissue_field.h"

namespace trephine {

// A solid voxel and those around it, of which some rows may be left out.
class VoxelSurroundings {
 public:
  // `apart`: voxels from one that is looked at to the next, 1: each. `tissue_class`: of the voxel,
  // which is solid. `tissue` outlives it.
  VoxelSurroundings(const TissueField& tissue, const Index3& voxel, const Index3& apart,
                    int tissue_class)
      : tissue_(tissue),
        voxel_(voxel),
        apart_(apart),
        threshold_(tissue.ofClass(tissue_class).hu_min - 0.5) {}

  // HU beyond the tissue's threshold so many steps from the voxel: above 0 where it is solid,
  // within kWhole_hu of 0; more or less than that counts as all of it, or as nothing.
  double beyond(const Index3& by) const {
    const GridGeometry& geometry = tissue_.geometry();
    const int i = voxel_[0] + by[0] * apart_[0], j = voxel_[1] + by[1] * apart_[1],
              k = voxel_[2] + by[2] * apart_[2];
    if (!geometry.contains(i, j, k)) return -kWhole_hu;
    const std::size_t there = geometry.indexOf(i, j, k);
    const std::int16_t hu = tissue_.hu(there);
    const double more = double(hu) - threshold_;
    return tissue_.isSolid(tissue_.classAt(there, hu))
               ? std::clamp(more, 1.0, kWhole_hu)
               : std::clamp(more, -kWhole_hu, -1.0);
  }
  Vec3 mesh_mm() const {
    return tissue_.geometry().spacing_mm * Vec3(apart_[0], apart_[1], apart_[2]);
  }

  static constexpr double kWhole_hu = 1226.0;

 private:
  const TissueField& tissue_;
  Index3 voxel_, apart_;
  double threshold_;
};

struct SurfaceFit {
  enum class Kind {
    behind,  // no surface in the voxel's own column: voxels beside it have it, and it is left out
    plate,   // no clear side, as thin as a voxel, or its far side: the voxel itself is the surface
    rough,   // the slope of the tissue, at the height of the voxel's own column
    flat,    // the plane of the columns around
  };
  // The two below are zero for `behind` and `plate`.
  Kind kind = Kind::behind;
  Vec3 above_mm{0.0};  // from the voxel's centre to the surface, the grid's own axes
  Vec3 normal{0.0};    // out of the tissue, unit
};

// `away_mm`: from the tool to the voxel, the grid's own axes; its direction alone counts.
SurfaceFit fitSurface(const VoxelSurroundings& around, const Vec3& away_mm);

}  // namespace trephine
