#include "haptics/contact.h"

#include <algorithm>

namespace trephine {

namespace {

constexpr std::size_t kTurns = 4;         // ticks from one look beyond the surface to the next
constexpr double kMostAlongBody = 128.0;  // points on the axis of a part of the body

}  // namespace

ToolContact::ToolContact(const Tool& tool, const GridGeometry& geometry, std::uint32_t by_points)
    : classes_(tool.points_m.size(), -1),
      voxels_(tool.points_m.size(), -1),
      patient_to_voxel_(geometry.patientToVoxel()),
      by_points_(by_points) {
  for (const Vec3& p : tool.points_m) points_mm_.push_back(1000.0 * p);
  low_mm_ = high_mm_ = points_mm_[0];
  for (const Vec3& p : points_mm_) {
    low_mm_ = glm::min(low_mm_, p);
    high_mm_ = glm::max(high_mm_, p);
  }
  const Vec3& spacing = geometry.spacing_mm;
  const double voxel_mm = std::min({spacing.x, spacing.y, spacing.z});
  for (const BodyPart& part : tool.body) {
    const Vec3 from = 1000.0 * part.from_m, along = 1000.0 * part.to_m - from;
    const int steps = int(std::min(glm::length(along) / voxel_mm, kMostAlongBody)) + 1;
    for (int n = 0; n <= steps; ++n) body_mm_.push_back(from + (double(n) / steps) * along);
  }
  reach_ = 1000.0 * tool.point_inset_m / spacing + 0.5;
}

void ToolContact::forget() {
  std::fill(classes_.begin(), classes_.end(), std::int8_t(-1));
  contact_ = Contact{};
}

bool ToolContact::wouldTouch(const TissueField& tissue, const Pose& pose_mm) const {
  const Vec3 tip = Vec3(patient_to_voxel_ * glm::dvec4(pose_mm.position, 1.0));
  const Mat3 to_voxel = Mat3(patient_to_voxel_) * glm::mat3_cast(pose_mm.orientation);
  const auto inTissue = [&](const Vec3& point_mm) {
    const Vec3 place = tip + to_voxel * point_mm;
    return tissue.mayHold(place, place) && touches(tissue.classAt(place));
  };
  if (isOutside(tissue, tip)) return false;
  return std::any_of(points_mm_.begin(), points_mm_.end(), inTissue) ||
         (by_points_ == 0 && std::any_of(body_mm_.begin(), body_mm_.end(), inTissue));
}

// Each place differs from the point along one axis alone, so its voxel is a step in memory away.
int ToolContact::classNear(const TissueField& tissue, const Vec3& place) const {
  const GridGeometry& g = tissue.geometry();
  const Vec3 v = place + 0.5;
  int firmest = -1;
  // True: nothing is firmer than what was found.
  const auto look = [&](int found) {
    if (found != firmest && tissue.firmer(found, firmest)) firmest = found;
    return firmest >= 0 && firmest == tissue.firmest();
  };
  const std::int64_t index = TissueField::voxelAt(g, place);
  if (index < 0) {
    for (int axis = 0; axis < 3; ++axis) {
      for (double reach : {reach_[axis], -reach_[axis]}) {
        Vec3 at = place;
        at[axis] += reach;
        if (look(tissue.classAt(at))) return firmest;
      }
    }
    return firmest;
  }
  std::int64_t step = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const int here = int(v[axis]), size = g.size[std::size_t(axis)];
    for (double reach : {reach_[axis], -reach_[axis]}) {
      const double there = v[axis] + reach;
      if (!(there >= 0.0 && there < size)) continue;
      if (look(tissue.classAt(std::size_t(index + (int(there) - here) * step)))) return firmest;
    }
    step *= size;
  }
  return firmest;
}

const Contact& ToolContact::update(const TissueField& tissue, const Pose& pose_mm) {
  const Vec3 tip = Vec3(patient_to_voxel_ * glm::dvec4(pose_mm.position, 1.0));
  const Mat3 to_voxel = Mat3(patient_to_voxel_) * glm::mat3_cast(pose_mm.orientation);
  contact_ = Contact{};
  // The box of the points, turned: its middle and half its extent along the grid's axes.
  const Vec3 middle = tip + to_voxel * (0.5 * (low_mm_ + high_mm_));
  const Vec3 half = 0.5 * (high_mm_ - low_mm_);
  const Vec3 extent = glm::abs(to_voxel[0]) * half.x + glm::abs(to_voxel[1]) * half.y +
                      glm::abs(to_voxel[2]) * half.z + reach_ + 1.0;
  if (isOutside(tissue, tip) || !tissue.mayHold(middle - extent, middle + extent)) {
    forget();
    return contact_;
  }
  ++turn_;
  std::int8_t firmest = -1;
  // The voxels of all points are on the way before the first is looked at.
  for (std::size_t i = 0; i < points_mm_.size(); ++i) {
    voxels_[i] = TissueField::voxelAt(tissue.geometry(), tip + to_voxel * points_mm_[i]);
    if (voxels_[i] >= 0) tissue.prefetch(std::size_t(voxels_[i]));
  }
  for (std::size_t i = 0; i < points_mm_.size(); ++i) {
    int found = voxels_[i] < 0 ? -1 : tissue.classAt(std::size_t(voxels_[i]));
    if (by_points_ != 0) {
      if (!touches(found)) found = -1;
    } else if (found < 0) {
      // Points in air between points in air take turns to look beyond the surface.
      const bool among_air = i > 0 && classes_[i] < 0 && classes_[i - 1] < 0 &&
                             (i + 1 == classes_.size() || classes_[i + 1] < 0);
      if (among_air && (i + turn_) % kTurns != 0) continue;
      found = classNear(tissue, tip + to_voxel * points_mm_[i]);
    }
    classes_[i] = std::int8_t(found);
    if (found < 0) continue;
    ++contact_.points;
    if (classes_[i] != firmest && tissue.firmer(classes_[i], firmest)) firmest = classes_[i];
  }
  contact_.tissue_class = firmest;
  return contact_;
}

}  // namespace trephine
