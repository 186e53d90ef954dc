#include "haptics/contact.h"

#include <algorithm>

namespace trephine {

namespace {

constexpr double kWay_mm = 0.05;  // a way is measured over this much, or noise would turn it

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
      patient_to_voxel_(geometry.patientToVoxel()),
      inset_mm_(1000.0 * tool.point_inset_m) {
  for (const Vec3& p : tool.points_m) points_mm_.push_back(1000.0 * p);
  const Vec3& spacing = geometry.spacing_mm;
  const double reach_mm =
      inset_mm_ + std::max({spacing.x, spacing.y, spacing.z});
  for (int n = 0; n < 6; ++n) {
    reach_[n] = Vec3(0.0);
    reach_[n][n / 2] = (n % 2 ? -reach_mm : reach_mm) / spacing[n / 2];
  }
}

void ToolContact::forget() {
  std::fill(classes_.begin(), classes_.end(), std::int8_t(-1));
  contact_ = Contact{};
}

void ToolContact::follow(const Vec3& tip_mm) {
  if (!(inset_mm_ > 0.0)) return;
  const Vec3 way_mm = from_mm_ ? tip_mm - *from_mm_ : Vec3(0.0);
  const double length_mm = glm::length(way_mm);
  if (from_mm_ && !(length_mm >= kWay_mm)) return;
  from_mm_ = tip_mm;
  if (length_mm > 0.0) {
    lead_ = Vec3(patient_to_voxel_ * glm::dvec4(way_mm * (inset_mm_ / length_mm), 0.0));
  }
}

bool ToolContact::tissueNear(const Grid& grid, const TissueLookup& lookup, const Vec3& voxel) {
  for (int n = 0; n < 6; ++n) {
    const int which = (last_found_ + n) % 6;
    if (classAt(grid, lookup, voxel + reach_[which]) < 0) continue;
    last_found_ = which;
    return true;
  }
  return false;
}

const Contact& ToolContact::update(const Grid& grid, const TissueLookup& lookup,
                                   const TissueTable& tissues, const Pose& pose_mm) {
  follow(pose_mm.position);
  const Vec3 tip = Vec3(patient_to_voxel_ * glm::dvec4(pose_mm.position, 1.0));
  const Mat3 to_voxel = Mat3(patient_to_voxel_) * glm::mat3_cast(pose_mm.orientation);
  contact_ = Contact{};
  std::int8_t firmest = -1;
  for (std::size_t i = 0; i < points_mm_.size(); ++i) {
    const Vec3 voxel = tip + to_voxel * points_mm_[i];
    int found = classAt(grid, lookup, voxel);
    if (found < 0 && from_mm_) found = classAt(grid, lookup, voxel + lead_);
    if (found >= 0) {
      ++contact_.points;
      classes_[i] = std::int8_t(found);
    } else if (classes_[i] >= 0 && !tissueNear(grid, lookup, voxel)) {
      classes_[i] = -1;
    }
    if (classes_[i] != firmest && firmer(tissues, classes_[i], firmest)) firmest = classes_[i];
  }
  contact_.tissue_class = firmest;
  return contact_;
}

}  // namespace trephine
