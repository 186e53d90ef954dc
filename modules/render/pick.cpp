#include "render/pick.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace trephine {

namespace {

// Of a ray, in mm along it.
struct Stretch {
  double from = 0.0, to = std::numeric_limits<double>::infinity();

  // Keeps what lies where a + b t <= 0.
  void keepBelow(double a, double b) {
    if (b == 0.0) {
      if (a > 0.0) to = -1.0;
    } else if (b > 0.0) {
      to = std::min(to, -a / b);
    } else {
      from = std::max(from, -a / b);
    }
  }
};

// What may lie between crumbs of a tissue, in mm: its surface, at first.
constexpr double kGap_mm = 2.5;

// Over 3 x 3 x 3 voxels.
double meanHu(const Volume& volume, const Index3& around) {
  const GridGeometry& g = volume.geometry;
  double sum = 0.0;
  int count = 0;
  for (int n = 0; n < 27; ++n) {
    const int i = around[0] + n % 3 - 1, j = around[1] + n / 3 % 3 - 1, k = around[2] + n / 9 - 1;
    if (!g.contains(i, j, k)) continue;
    sum += volume.at(i, j, k);
    ++count;
  }
  return sum / count;
}

}  // namespace

std::optional<Picked> pick(const Volume& volume, const LabelMap* labels, const TissueSet& tissues,
                           const TissueLooks& looks, const std::vector<ClipPlane>& clip,
                           const ViewCamera::Ray& ray) {
  const GridGeometry& g = volume.geometry;
  if (volume.hu.empty() || !isFinite(ray.from_mm) || !isFinite(ray.direction)) return {};
  const TissueSet seen = asSeen(tissues, looks);
  const TissueTable table = tissueTable(seen);
  std::array<double, kMaxTissues> opacity{};  // 0 for what a ray passes
  for (std::size_t n = 0; n < std::size_t(table.count); ++n) {
    const Tissue& tissue = seen.tissues[n];
    if (lookOf(tissue, looks) != TissueLook::ghosted) opacity[n] = std::min(tissue.opacity, 0.995);
  }

  const Mat4 to_voxel = g.patientToVoxel();
  const Vec3 start = Vec3(to_voxel * glm::dvec4(ray.from_mm, 1.0)) + 0.5;  // whole numbers at faces
  const Vec3 along = Vec3(to_voxel * glm::dvec4(ray.direction, 0.0));      // per mm
  Stretch within;
  for (int axis = 0; axis < 3; ++axis) {
    within.keepBelow(-start[axis], -along[axis]);
    within.keepBelow(start[axis] - g.size[std::size_t(axis)], along[axis]);
  }
  for (const ClipPlane& plane : clip) {
    within.keepBelow(glm::dot(plane.normal, ray.from_mm - plane.point_mm),
                     glm::dot(plane.normal, ray.direction));
  }
  const double step_mm = 0.5 * std::min({g.spacing_mm.x, g.spacing_mm.y, g.spacing_mm.z});

  const auto voxelOn = [&](double t) {
    const Vec3 at = start + along * t;
    Index3 voxel;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      voxel[axis] = std::clamp(int(std::floor(at[int(axis)])), 0, g.size[axis] - 1);
    }
    return voxel;
  };
  const auto classOn = [&](double t) {
    const Index3 voxel = voxelOn(t);
    const std::size_t index = g.indexOf(voxel[0], voxel[1], voxel[2]);
    const int of = classify(table, volume.hu[index], labels ? labels->labels[index] : 0);
    return of >= 0 && opacity[std::size_t(of)] > 0.0 ? of : -1;
  };

  std::optional<double> first;
  double begins = 0.0, clear = 1.0;
  int last = -1;
  for (double t = within.from + 0.5 * step_mm; t < within.to && clear > 0.5; t += step_mm) {
    const int of = classOn(t);
    if (of >= 0 && of != last) begins = t;
    last = of;
    if (of < 0) continue;
    if (!first) first = t;
    clear *= std::pow(1.0 - opacity[std::size_t(of)], step_mm);
  }
  if (!first) return {};
  const double at = clear > 0.5 ? *first : begins;
  const int of = classOn(at);
  // By HU alone an organ's rim is of another tissue, and noise breaks it into crumbs that means do
  // not have: there all that is seen goes on.
  const bool by_label = !seen.tissues[std::size_t(of)].isAnywhere();
  const auto goesOn = [&](double t) {
    const int here = classOn(t);
    if (here == of || by_label) return here == of;
    const int mean = classify(table, meanHu(volume, voxelOn(t)));
    return here >= 0 || (mean >= 0 && opacity[std::size_t(mean)] > 0.0);
  };
  double inside = at;
  for (double t = at; t < std::min(within.to, at + kInside_mm) && t < inside + kGap_mm;
       t += step_mm) {
    if (goesOn(t)) inside = t;
  }
  const Index3 voxel = voxelOn(at);
  return Picked{g.toPatient_mm(Vec3(voxel[0], voxel[1], voxel[2])),
                ray.from_mm + ray.direction * inside};
}

}  // namespace trephine
