#include "render/look_table.h"

#include <algorithm>
#include <cmath>

#include "render/transfer_function.h"

namespace trephine {

namespace {

// Enough for a surface to stop the ray that asks; what is drawn of a ghost is the shader's.
constexpr double kGhostOpacity = 0.05;

TissueLook lookOf(const TissueLooks& looks, const Tissue& tissue) {
  const auto found = looks.find(tissue.id);
  return found == looks.end() ? TissueLook::shown : found->second;
}

}  // namespace

TissueSet asSeen(TissueSet set, const TissueLooks& looks) {
  for (Tissue& tissue : set.tissues) {
    const TissueLook look = lookOf(looks, tissue);
    if (look == TissueLook::hidden) tissue.opacity = 0.0;
    if (look == TissueLook::ghosted) tissue.opacity = kGhostOpacity;
  }
  return set;
}

std::vector<TissueShade> tissueShades(const TissueSet& seen, const TissueLooks& looks,
                                      double highest_HU) {
  const LabelRows rows(tissueTable(seen));
  std::vector<TissueShade> shades;
  for (const bool labelled : {false, true}) {
    for (const Tissue& tissue : seen.tissues) {
      if (tissue.opacity <= 0.0 || tissue.label.has_value() != labelled) continue;
      // A ramp towards what is transparent belongs to the tissue.
      const auto beside = [&](int hu) {
        return std::ranges::any_of(seen.tissues, [&](const Tissue& other) {
          return other.opacity > 0.0 && other.label == tissue.label && other.hu_min <= hu &&
                 hu <= other.hu_max;
        });
      };
      const double below = beside(tissue.hu_min - 1) ? 0.0 : kRampHalfWidth_HU;
      const double above = beside(tissue.hu_max + 1) ? 0.0 : kRampHalfWidth_HU;
      TissueShade shade;
      shade.low_HU = tissue.hu_min - 0.5 - below;
      shade.high_HU = tissue.hu_max + 0.5 + above;
      if (tissue.label) shade.row = rows.row[std::size_t(*tissue.label)];
      shade.passed = !labelled && tissue.hu_max < highest_HU;
      shade.ghosted = lookOf(looks, tissue) == TissueLook::ghosted;
      shade.colour = tissue.colour;
      shades.push_back(shade);
    }
  }
  return shades;
}

std::vector<Vec3> sphereDirections(int count) {
  const double turn = std::acos(-1.0) * (3.0 - std::sqrt(5.0));
  std::vector<Vec3> directions;
  for (int n = 0; n < count; ++n) {
    const double z = 1.0 - (n + 0.5) * 2.0 / count, r = std::sqrt(1.0 - z * z);
    directions.emplace_back(std::cos(turn * n) * r, std::sin(turn * n) * r, z);
  }
  return directions;
}

Vec3 ballRadii_mm(const Vec3& spacing_mm) {
  // 1.75 voxels: 1.5 mm at 0.8 x 0.8 x 1.0 mm. At least a voxel where slices are far apart.
  const double mean_mm = std::cbrt(spacing_mm.x * spacing_mm.y * spacing_mm.z);
  return glm::max(Vec3(1.75 * mean_mm), spacing_mm);
}

}  // namespace trephine
