// Balls within balls, at the middle of a cube of air: as much of an anatomy as a test needs.
#pragma once

#include <initializer_list>

#include "volume/volume.h"

namespace trephine::test {

struct Ball {
  double radius_mm;
  int hu;
};

// `edge` voxels a side; the largest ball first.
inline Volume shells(int edge, double voxel_mm, std::initializer_list<Ball> balls) {
  Volume v;
  GridGeometry& g = v.geometry;
  g.size = {edge, edge, edge};
  g.spacing_mm = Vec3(voxel_mm);
  g.origin_mm = Vec3(-voxel_mm * (edge - 1) / 2.0);
  v.hu.resize(g.voxelCount());
  std::size_t at = 0;
  for (int k = 0; k < edge; ++k) {
    for (int j = 0; j < edge; ++j) {
      for (int i = 0; i < edge; ++i, ++at) {
        const double r = glm::length(g.toPatient_mm(Vec3(i, j, k)));
        int hu = kAirHu;
        for (const Ball& ball : balls) {
          if (r < ball.radius_mm) hu = ball.hu;
        }
        v.hu[at] = std::int16_t(hu);
      }
    }
  }
  return v;
}

}  // namespace trephine::test
