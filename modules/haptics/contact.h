// Contact by HU look-up: which of a tool's points lie in which tissue.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"
#include "haptics/tissue_field.h"
#include "haptics/tool.h"

namespace trephine {

struct Contact {
  std::int32_t tissue_class = -1;  // the firmest tissue touched; -1 none
  std::int32_t points = 0;         // sample points that touch
  bool touching() const { return tissue_class >= 0; }
};

// The contact of one tool, point by point. A point touches the tissue of the voxel that it lies in;
// if that is air, the firmest tissue that lies half a voxel beyond the surface of the solid that
// cuts, in any of the grid's six directions: so tissue is felt before it is cut, and the walls of a
// slot rub on the blade in it. (Where no neighbour touches either, a point other than the tip looks
// beyond the surface every fourth tick only.)
//
// By points alone, the seed paper's rule: a point touches where the voxel that it lies in is of one
// of certain tissues, and nothing touches while the tip is outside of the grid.
class ToolContact {
 public:
  // `by_points`: those tissues, a bit for each class; 0: all tissues, by points and solid.
  ToolContact(const Tool& tool, const GridGeometry& geometry, std::uint32_t by_points = 0);

  // Looks up every point of the tool at `pose_mm`. No allocation.
  const Contact& update(const TissueField& tissue, const Pose& pose_mm);
  void forget();
  // Whether any point of the tool, or of the axis of its shaft, would be in tissue at a pose.
  bool wouldTouch(const TissueField& tissue, const Pose& pose_mm) const;

  const Contact& contact() const { return contact_; }
  // The tissue of each point of the tool, -1 air.
  std::span<const std::int8_t> classes() const { return classes_; }
  // The voxels that they lie in, of those that touch by points alone.
  std::span<const std::int64_t> voxels() const { return voxels_; }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive.same(self.classes_.size());
    for (auto& one : self.classes_) archive.within(one, -1, kMaxTissues);
    archive(self.turn_);
  }

 private:
  int classNear(const TissueField& tissue, const Vec3& place) const;
  // Whether a point in a voxel of this class touches.
  bool touches(int tissue_class) const {
    return tissue_class >= 0 && (by_points_ == 0 || (by_points_ >> tissue_class & 1u));
  }
  // By points alone, and the tip (in voxels) is where there are none.
  bool isOutside(const TissueField& tissue, const Vec3& tip) const {
    return by_points_ != 0 && TissueField::voxelAt(tissue.geometry(), tip) < 0;
  }

  std::vector<Vec3> points_mm_;  // tool frame
  std::vector<Vec3> body_mm_;    // along the axes of its body, a voxel apart
  std::vector<std::int8_t> classes_;
  std::vector<std::int64_t> voxels_;  // of the points, in this tick; -1 outside
  Mat4 patient_to_voxel_;
  std::uint32_t by_points_;
  Vec3 low_mm_{0.0}, high_mm_{0.0};  // box of the points, tool frame
  std::size_t turn_ = 0;             // of the points that look beyond the surface every fourth tick
  Vec3 reach_{0.0};  // voxels, from a point to half a voxel beyond the surface, along each axis
  Contact contact_;
};

}  // namespace trephine
