#include "render/look_table.h"

#include <algorithm>
#include <cmath>

namespace trephine {

std::vector<TissueShade> tissueShades(const TissueSet& seen, const TissueLooks& looks,
                                      double highest_HU) {
  const LabelRows rows(tissueTable(seen));
  std::vector<TissueShade> shades;
  for (const bool labelled : {false, true}) {
    for (const Tissue& tissue : seen.tissues) {
      if (tissue.opacity <= 0.0 || tissue.isAnywhere() == labelled) continue;
      TissueShade shade;
      shade.low_HU = tissue.hu_min - 0.5;
      shade.high_HU = tissue.hu_max + 0.5;
      if (tissue.label) shade.row = rows.row[std::size_t(*tissue.label)];
      shade.passed = !labelled && tissue.hu_max < highest_HU;
      shade.ghosted = lookOf(tissue, looks) == TissueLook::ghosted;
      shade.colour = tissue.colour;
      shades.push_back(shade);
    }
  }
  return shades;
}

Vec3 cutColour(const Vec3& colour) {
  const double light = std::clamp(glm::dot(colour, Vec3(0.3, 0.59, 0.11)), 0.0, 1.0);
  const Vec3 pink = colour * Vec3(1.1, 0.8, 0.76),
             pale = glm::mix(colour, Vec3(1.0, 0.72, 0.62), 0.6);
  return glm::min(Vec3(1.0), glm::mix(pale, pink, glm::smoothstep(0.3, 0.7, light)));
}

Vec3 ballRadii_mm(const Vec3& spacing_mm) {
  // 1.5 mm at 0.8 x 0.8 x 1.0 mm.
  const double mean_mm = std::cbrt(spacing_mm.x * spacing_mm.y * spacing_mm.z);
  return glm::max(Vec3(1.75 * mean_mm), spacing_mm);
}

RayBall rayBall(const Vec3& spacing_mm, int places) {
  const Vec3 radii_mm = ballRadii_mm(spacing_mm);
  const double reach_mm = std::cbrt(radii_mm.x * radii_mm.y * radii_mm.z);
  const double turn = std::acos(-1.0) * (3.0 - std::sqrt(5.0));
  RayBall ball;
  for (int n = 0; n < places; ++n) {
    const double z = 1.0 - (n + 0.5) * 2.0 / places, r = std::sqrt(1.0 - z * z);
    const Vec3 direction(std::cos(turn * n) * r, std::sin(turn * n) * r, z);
    // Half of the directions are beyond an edge, on average by half of the reach.
    ball.push_back({direction * radii_mm, direction * (4.0 / places * reach_mm) / radii_mm});
  }
  return ball;
}

RayBall centralDifferences(const Vec3& spacing_mm) {
  RayBall ball;
  const double mean_mm = std::cbrt(spacing_mm.x * spacing_mm.y * spacing_mm.z);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      RayPlace place;
      place.from_mm[axis] = sign * spacing_mm[axis];
      place.weight[axis] = 0.5 * sign * mean_mm / spacing_mm[axis];
      ball.push_back(place);
    }
  }
  return ball;
}

}  // namespace trephine
