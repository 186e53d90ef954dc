// A volume to look at, for measurements of views.
#pragma once

#include "volume/volume.h"

namespace trephine::bench {

// A ball of bone around brain, with noise, so that no picture is like the one before.
inline Volume head(const Index3& size, const Mat3& direction) {
  Volume volume;
  GridGeometry& g = volume.geometry;
  g.size = size;
  g.spacing_mm = {0.45, 0.45, 0.7};
  g.direction = direction;
  volume.hu.resize(g.voxelCount());
  const Vec3 middle = Vec3(size[0] - 1, size[1] - 1, size[2] - 1) * 0.5;
  std::size_t at = 0;
  unsigned noise = 1;
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i, ++at) {
        noise = noise * 1664525u + 1013904223u;
        const double r = glm::length((Vec3(i, j, k) - middle) * g.spacing_mm);
        const int hu = r > 95 ? -1000 : r > 90 ? -20 : r > 82 ? 1200 : 35;
        volume.hu[at] = std::int16_t(hu + int(noise >> 28));
      }
    }
  }
  return volume;
}

}  // namespace trephine::bench
