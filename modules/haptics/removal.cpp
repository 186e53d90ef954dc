#include "haptics/removal.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace trephine {

namespace {

// What a tick of a millisecond or less may look at, in voxels, and a slower one more; a row of the
// solid counts as much as these many.
constexpr int kLooksPerTick = 4096;
constexpr double kMostLooks = 4.0;  // times that
constexpr int kLooksPerRow = 12;
constexpr double kHalfVoxel = 0.505;  // and a little, for what rounding takes
constexpr double kKept_s = 0.05;
// No hand is as fast: a pose that jumps sweeps nothing between.
constexpr double kFastest_mm_per_s = 5000.0;

double voxelWork_J(const TissueClass& tissue, double voxel_mm3) {
  return tissue.cutting_J_per_mm3 * voxel_mm3;
}

// The first and last whole index within an interval, cut to 0 .. count - 1; empty: first > last.
std::pair<int, int> indices(const Interval& mm, double spacing_mm, int count) {
  if (mm.empty()) return {0, -1};
  const double low = std::ceil(std::clamp(mm.low / spacing_mm, -1.0, double(count)));
  const double high = std::floor(std::clamp(mm.high / spacing_mm, -1.0, double(count)));
  return {std::max(0, int(low)), std::min(count - 1, int(high))};
}

}  // namespace

Removal::Removal(const Tool& tool, const GridGeometry& geometry, RemovalKind kind, double period_s)
    : tool_(tool),
      geometry_(geometry),
      patient_to_voxel_(geometry.patientToVoxel()),
      kind_(kind),
      fading_(1.0 / (1.0 + period_s / kKept_s)) {
  radius_mm_ = 1000.0 * tool.radius_m;
  spacing_mm_ = glm::min(geometry.spacing_mm, Vec3(radius_mm_ / kHalfVoxel));
  const Vec3& s = spacing_mm_;
  layer_mm_ = std::max({s.x, s.y, s.z, 0.1 * radius_mm_});
  still_mm_ = 0.125 * std::min({s.x, s.y, s.z});
  looks_ = int(kLooksPerTick * std::clamp(1000.0 * period_s, 1.0, kMostLooks));
  farthest_mm_ = kFastest_mm_per_s * period_s;
}

Capsule Removal::capsuleAt(const Pose& pose_mm) const {
  const auto place = [&](const Vec3& tool_m) {
    const Vec3 patient_mm = pose_mm.position + 1000.0 * (pose_mm.orientation * tool_m);
    return Vec3(patient_to_voxel_ * glm::dvec4(patient_mm, 1.0)) * spacing_mm_;
  };
  return {place(tool_.solid_from_m), place(tool_.solid_to_m), radius_mm_};
}

void Removal::earn(double work_J, const TissueTable& tissues) {
  double dearest_J = 0.0;
  for (int c = 0; c < tissues.count; ++c) {
    const TissueClass& t = tissues.classes[std::size_t(c)];
    if (t.cuttable) dearest_J = std::max(dearest_J, voxelWork_J(t, geometry_.voxelVolume_mm3()));
  }
  recent_J_ = fading_ * (recent_J_ + std::max(0.0, work_J));
  const double cap_J = recent_J_ + 2.0 * dearest_J;
  credit_J_ = std::clamp(credit_J_ + work_J, -cap_J, cap_J);
}

void Removal::begin(const Capsule& now) {
  goal_ = now;
  const double clear_mm = known_ ? clear_.radius : -layer_mm_;
  goal_.radius = std::min(radius_mm_, std::max(0.0, clear_mm) + layer_mm_);
  if (kind_ == RemovalKind::instant || !known_) goal_.radius = radius_mm_;
  Capsule from = known_ ? clear_ : goal_;
  from.radius = goal_.radius;
  solid_ = SweptSolid(from, goal_);
  std::tie(low_[2], high_[2]) =
      indices(solid_.depth(), spacing_mm_.z, geometry_.size[2]);
  slice_ = 0;
  slice_end_ = high_[2] - low_[2] + 1;
  row_ = -1;
  paid_ = true;
  passing_ = true;
  backwards_ = !backwards_;
}

void Removal::end(const Capsule& now) {
  passing_ = false;
  if (paid_) {
    clear_ = goal_;
    known_ = true;
    return;
  }
  // What was clear around the last place is clear around this one as far as it reaches.
  const double clear_mm = known_ ? clear_.radius - moved(clear_, now) : 0.0;
  clear_ = now;
  clear_.radius = std::max(0.0, clear_mm);
  known_ = true;
}

void Removal::sweep(const Grid& grid, const TissueLookup& lookup, const TissueTable& tissues,
                    const Pose& pose_mm, std::vector<Bite>& bites) {
  const Capsule now = capsuleAt(pose_mm);
  if (last_ && !(moved(*last_, now) <= farthest_mm_)) forget();
  last_ = now;
  // Work ran short and the tool went on: it must not take later what it has left.
  if (passing_ && !paid_ && moved(goal_, now) > layer_mm_) end(now);
  if (!passing_) {
    const bool all = known_ && clear_.radius >= radius_mm_;
    if (all && moved(clear_, now) < still_mm_) return;
    begin(now);
  }
  const Vec3& s = spacing_mm_;
  const double voxel_mm3 = geometry_.voxelVolume_mm3();
  int looks = looks_;
  for (; slice_ < slice_end_; ++slice_) {
    const int k = backwards_ ? high_[2] - slice_ : low_[2] + slice_;
    const double z = k * s.z;
    if (row_ < 0) {
      std::tie(low_[1], high_[1]) = indices(solid_.band(z), s.y, geometry_.size[1]);
      row_ = 0;
    }
    for (; row_ <= high_[1] - low_[1]; ++row_) {
      const int j = backwards_ ? high_[1] - row_ : low_[1] + row_;
      const double y = j * s.y;
      looks -= kLooksPerRow * solid_.places();
      const auto [first, last] = indices(solid_.row(y, z), s.x, geometry_.size[0]);
      if (first <= last) {
        const auto [clear_first, clear_last] =
            known_ ? indices(rowWithin(clear_, y, z), s.x, geometry_.size[0]) : std::pair(0, -1);
        for (int i = first; i <= last; ++i) {
          if (i >= clear_first && i <= clear_last) {
            i = clear_last;
            continue;
          }
          --looks;
          const std::int16_t hu = grid.hu(geometry_.indexOf(i, j, k));
          const int c = hu == kAirHu ? -1 : lookup.classOf(hu);
          if (c < 0 || !tissues.classes[std::size_t(c)].cuttable) continue;
          const double cost_J = kind_ == RemovalKind::instant
                                    ? 0.0
                                    : voxelWork_J(tissues.classes[std::size_t(c)], voxel_mm3);
          const bool affords = kind_ == RemovalKind::instant || credit_J_ >= cost_J;
          if (!affords) paid_ = false;
          if (!affords || bites.size() == kMostBites) return;  // goes on here in the next tick
          credit_J_ -= cost_J;
          bites.push_back({{i, j, k}, c, cost_J});
        }
      }
      if (looks <= 0) {
        ++row_;
        return;
      }
    }
    row_ = -1;
  }
  paid_ = true;  // waited for, but paid in the end
  end(now);
}

}  // namespace trephine
