// Uncut solid tissue inside of a tool.
#pragma once

#include <algorithm>

#include "haptics/tool.h"
#include "tissue/tissue_set.h"
#include "volume/volume.h"

namespace trephine::test {

// How deep the centre of a voxel of solid tissue lies in the tool's body, at most; below 0:
// nowhere.
struct Inside {
  int voxels = 0;  // deeper than half a voxel
  double deepest_mm = -1e9;
};

inline void lookInside(const Volume& volume, const TissueTable& tissues, const BodyPart& part,
                       const Pose& pose_mm, Inside& inside) {
  const GridGeometry& g = volume.geometry;
  const Vec3 from_mm = pose_mm.position + pose_mm.orientation * (1000.0 * part.from_m);
  const Vec3 along_mm = pose_mm.orientation * (1000.0 * (part.to_m - part.from_m));
  const Vec3 a = Vec3(g.patientToVoxel() * glm::dvec4(from_mm, 1.0));
  const Vec3 b = Vec3(g.patientToVoxel() * glm::dvec4(from_mm + along_mm, 1.0));
  const double radius_mm = 1000.0 * part.radius_m;
  const double half_mm = 0.5 * std::min({g.spacing_mm.x, g.spacing_mm.y, g.spacing_mm.z});
  const Vec3 reach = radius_mm / g.spacing_mm;
  Index3 low{}, high{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int i = int(axis);
    low[axis] = int(std::clamp(std::min(a[i], b[i]) - reach[i], 0.0, double(g.size[axis])));
    high[axis] = int(std::clamp(std::max(a[i], b[i]) + reach[i] + 1.0, 0.0, double(g.size[axis])));
  }
  const double length2 = glm::dot(along_mm, along_mm);
  for (int k = low[2]; k < high[2]; ++k) {
    for (int j = low[1]; j < high[1]; ++j) {
      for (int i = low[0]; i < high[0]; ++i) {
        const int c = classify(tissues, volume.at(i, j, k), 0);
        if (c < 0 || !tissues.classes[std::size_t(c)].solid) continue;
        const Vec3 to_mm = g.toPatient_mm(Vec3(i, j, k)) - from_mm;
        const double t =
            length2 > 0.0 ? std::clamp(glm::dot(to_mm, along_mm) / length2, 0.0, 1.0) : 0.0;
        const double deep_mm = radius_mm - glm::length(to_mm - t * along_mm);
        inside.deepest_mm = std::max(inside.deepest_mm, deep_mm);
        if (deep_mm > half_mm) ++inside.voxels;
      }
    }
  }
}

}  // namespace trephine::test
