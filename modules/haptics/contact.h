// Contact by HU look-up: which of a tool's points lie in which tissue.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/math.h"
#include "haptics/tissue_lookup.h"
#include "haptics/tool.h"
#include "volume/grid.h"

namespace trephine {

struct Contact {
  std::int32_t tissue_class = -1;  // the firmest tissue touched; -1 none
  std::int32_t points = 0;         // sample points in tissue, held ones not counted
  bool touching() const { return tissue_class >= 0; }
};

// The nearest voxel to a patient position, or -1 outside the grid (which counts as air). Any value
// is answered, infinities and NaN too.
std::int64_t nearestVoxel(const GridGeometry& geometry, const Mat4& patient_to_voxel,
                          const Vec3& patient_mm);

// The contact of one tool, point by point. A point inside the solid that cuts touches also with the
// surface of that solid before it, the way the tool goes: else the tissue would go before it is
// felt. A tool that erases what it touches would lose contact at
// once and find it again a voxel later; so a point that was in tissue keeps that tissue while any
// stands within reach of it along the grid's axes: from the point to the surface of what the
// tool cuts, and one voxel on.
class ToolContact {
 public:
  ToolContact(const Tool& tool, const GridGeometry& geometry);

  // Looks up every point of the tool at `pose_mm`. No allocation.
  const Contact& update(const Grid& grid, const TissueLookup& lookup, const TissueTable& tissues,
                        const Pose& pose_mm);
  void forget();

  const Contact& contact() const { return contact_; }
  // The tissue of each point of the tool, -1 air.
  std::span<const std::int8_t> classes() const { return classes_; }

 private:
  void follow(const Vec3& tip_mm);
  bool tissueNear(const Grid& grid, const TissueLookup& lookup, const Vec3& voxel);

  std::vector<Vec3> points_mm_;  // tool frame
  std::vector<std::int8_t> classes_;
  Mat4 patient_to_voxel_;
  double inset_mm_;
  std::optional<Vec3> from_mm_;  // where the way was last measured
  Vec3 lead_{0.0};     // voxels: the way the tool goes, as long as the inset
  Vec3 reach_[6];      // voxels: there and back along the grid's axes
  int last_found_ = 0;  // the first of them to try: walls stay where they are
  Contact contact_;
};

}  // namespace trephine
