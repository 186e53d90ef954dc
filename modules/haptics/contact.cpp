#include "haptics/contact.h"

#include <algorithm>

namespace trephine {

namespace {

// -1 outside; written so that NaN falls out as "outside".
std::int64_t voxelAt(const GridGeometry& geometry, const Vec3& voxel) {
  const Vec3 v = voxel + 0.5;
  const bool inside = v.x >= 0.0 && v.y >= 0.0 && v.z >= 0.0 && v.x < geometry.size[0] &&
                      v.y < geometry.size[1] && v.z < geometry.size[2];
  if (!inside) return -1;
  return std::int64_t(geometry.indexOf(int(v.x), int(v.y), int(v.z)));
}

int classAt(const Grid& grid, const TissueLookup& lookup, const Vec3& voxel) {
  const std::int64_t index = voxelAt(grid.geometry(), voxel);
  return index < 0 ? -1 : lookup.classOf(grid.hu(std::size_t(index)));
}

}  // namespace

std::int64_t nearestVoxel(const GridGeometry& geometry, const Mat4& patient_to_voxel,
                          const Vec3& patient_mm) {
  return voxelAt(geometry, Vec3(patient_to_voxel * glm::dvec4(patient_mm, 1.0)));
}

ToolContact::ToolContact(const Tool& tool, const GridGeometry& geometry)
    : classes_(tool.points_m.size(), -1),
      voxels_(tool.points_m.size(), -1),
      patient_to_voxel_(geometry.patientToVoxel()) {
  for (const Vec3& p : tool.points_m) points_mm_.push_back(1000.0 * p);
  low_mm_ = high_mm_ = points_mm_[0];
  for (const Vec3& p : points_mm_) {
    low_mm_ = glm::min(low_mm_, p);
    high_mm_ = glm::max(high_mm_, p);
  }
  const Vec3& spacing = geometry.spacing_mm;
  for (int n = 0; n < 6; ++n) {
    reach_[n] = Vec3(0.0);
    const double reach = 1000.0 * tool.point_inset_m / spacing[n / 2] + 0.5;
    reach_[n][n / 2] = n % 2 ? -reach : reach;
  }
}

void ToolContact::forget() {
  std::fill(classes_.begin(), classes_.end(), std::int8_t(-1));
  contact_ = Contact{};
}

int ToolContact::classNear(const Grid& grid, const TissueLookup& lookup,
                           const TissueTable& tissues, const Vec3& voxel) const {
  int firmest = -1;
  for (const Vec3& reach : reach_) {
    const int found = classAt(grid, lookup, voxel + reach);
    if (found != firmest && firmer(tissues, found, firmest)) firmest = found;
  }
  return firmest;
}

const Contact& ToolContact::update(const Grid& grid, const TissueBricks& bricks,
                                   const TissueLookup& lookup, const TissueTable& tissues,
                                   const Pose& pose_mm) {
  const Vec3 tip = Vec3(patient_to_voxel_ * glm::dvec4(pose_mm.position, 1.0));
  const Mat3 to_voxel = Mat3(patient_to_voxel_) * glm::mat3_cast(pose_mm.orientation);
  contact_ = Contact{};
  // The box of the points, turned: its middle and half its extent along the grid's axes.
  const Vec3 middle = tip + to_voxel * (0.5 * (low_mm_ + high_mm_));
  const Vec3 half = 0.5 * (high_mm_ - low_mm_);
  const Vec3 extent = glm::abs(to_voxel[0]) * half.x + glm::abs(to_voxel[1]) * half.y +
                      glm::abs(to_voxel[2]) * half.z + Vec3(reach_[0].x, reach_[2].y, reach_[4].z) + 1.0;
  if (!bricks.mayHold(middle - extent, middle + extent)) {
    forget();
    return contact_;
  }
  std::int8_t firmest = -1;
  // The voxels of all points are on the way before the first is looked at.
  for (std::size_t i = 0; i < points_mm_.size(); ++i) {
    voxels_[i] = voxelAt(grid.geometry(), tip + to_voxel * points_mm_[i]);
    if (voxels_[i] >= 0) grid.prefetch(std::size_t(voxels_[i]));
  }
  for (std::size_t i = 0; i < points_mm_.size(); ++i) {
    int found = voxels_[i] < 0 ? -1 : lookup.classOf(grid.hu(std::size_t(voxels_[i])));
    if (found < 0) found = classNear(grid, lookup, tissues, tip + to_voxel * points_mm_[i]);
    classes_[i] = std::int8_t(found);
    if (found < 0) continue;
    ++contact_.points;
    if (classes_[i] != firmest && firmer(tissues, classes_[i], firmest)) firmest = classes_[i];
  }
  contact_.tissue_class = firmest;
  return contact_;
}

}  // namespace trephine
