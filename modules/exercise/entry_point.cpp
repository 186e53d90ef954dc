#include "exercise/entry_point.h"

#include <algorithm>
#include <cmath>

namespace trephine {

namespace {

constexpr double kBody_HU = -300.0;  // half-way from skin to air, roughly
// Of the ball's radius: half a ball, of a flat surface, has its middle at 3/8 of it.
constexpr double kLeastPull = 0.12;

// The mean offset of the ball's voxels that are in, from its middle, in radii; out of the grid
// nothing is in.
template <class In>
Vec3 pullOf(const GridGeometry& g, const Vec3& at_mm, const In& in) {
  const Vec3 middle = Vec3(g.patientToVoxel() * glm::dvec4(at_mm, 1.0));
  Index3 low, high;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = std::size_t(axis);
    const double reach = kEntryBall_mm / g.spacing_mm[axis];
    low[a] = std::max(0, int(std::ceil(middle[axis] - reach)));
    high[a] = std::min(g.size[a] - 1, int(std::floor(middle[axis] + reach)));
  }
  Vec3 sum(0.0);
  std::size_t count = 0;
  for (int k = low[2]; k <= high[2]; ++k) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int i = low[0]; i <= high[0]; ++i) {
        if (!in(i, j, k)) continue;
        const Vec3 off = g.toPatient_mm(Vec3(i, j, k)) - at_mm;
        if (glm::length(off) > kEntryBall_mm) continue;
        sum += off;
        ++count;
      }
    }
  }
  return count ? sum / (double(count) * kEntryBall_mm) : Vec3(0.0);
}

}  // namespace

const Landmark* entryLandmark(const Exercise& exercise) {
  if (const Landmark* seen = exercise.findLandmarkById(exercise.view.landmark)) return seen;
  for (const ExerciseArm& arm : exercise.arms) {
    if (const Landmark* of = exercise.findLandmarkById(arm.map.landmark)) return of;
  }
  return nullptr;
}

std::optional<Vec3> outwardAt(const Volume& volume, const TissueSet& tissues,
                              const LabelMap* labels, const std::string& tissue,
                              const Vec3& at_mm) {
  const GridGeometry& g = volume.geometry;
  const auto outOf = [](const Vec3& pull) -> std::optional<Vec3> {
    if (!(glm::length(pull) > kLeastPull)) return {};
    return -glm::normalize(pull);
  };
  const auto out_of_body =
      outOf(pullOf(g, at_mm, [&](int i, int j, int k) { return volume.at(i, j, k) > kBody_HU; }));
  const Tissue* of = tissues.find(tissue);
  if (out_of_body || !of) return out_of_body;
  const TissueTable table = tissueTable(tissues);
  const int wanted = int(of - tissues.tissues.data());
  return outOf(pullOf(g, at_mm, [&](int i, int j, int k) {
    const std::uint8_t label = labels ? labels->labels[g.indexOf(i, j, k)] : 0;
    return classify(table, volume.at(i, j, k), label) == wanted;
  }));
}

double depthInTissue_mm(const Volume& volume, const TissueSet& tissues, const LabelMap* labels,
                        const Vec3& at_mm, const Vec3& outward) {
  constexpr double kStep_mm = 0.5;
  const GridGeometry& g = volume.geometry;
  const glm::dmat4 to_voxel = g.patientToVoxel();
  const TissueTable table = tissueTable(tissues);
  double last_mm = 0.0;
  for (double way_mm = kStep_mm; way_mm < std::min(kDeepest_mm, last_mm + kClear_mm);
       way_mm += kStep_mm) {
    const Vec3 voxel = glm::round(Vec3(to_voxel * glm::dvec4(at_mm + way_mm * outward, 1.0)));
    const int i = int(voxel.x), j = int(voxel.y), k = int(voxel.z);
    if (!g.contains(i, j, k)) break;
    const std::uint8_t label = labels ? labels->labels[g.indexOf(i, j, k)] : 0;
    if (classify(table, volume.at(i, j, k), label) >= 0) last_mm = way_mm;
  }
  return last_mm;
}

Landmark placedAt(const Landmark& landmark, const Vec3& at_mm, const Vec3& outward) {
  Landmark placed = landmark;
  placed.is_place = true;
  placed.at_mm = at_mm;
  placed.outward = outward;
  placed.bulk_radius_mm = 0.0;
  return placed;
}

}  // namespace trephine
