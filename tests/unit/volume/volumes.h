// Small volumes for the tests of this room.
#pragma once

#include "volume/volume.h"

namespace trephine::test {

// Voxels that differ from all their neighbours, over the whole range of a CT.
inline Volume patternVolume(const Index3& size) {
  Volume volume;
  volume.geometry.size = size;
  volume.hu.resize(volume.geometry.voxelCount());
  for (std::size_t i = 0; i < volume.hu.size(); ++i) {
    volume.hu[i] = std::int16_t(int(i * 7919 % 4096) - 1024);
  }
  return volume;
}

// One that lies oblique in the patient, with three different spacings.
inline Volume obliqueVolume(const Index3& size) {
  Volume volume = patternVolume(size);
  volume.geometry.spacing_mm = {0.7, 1.1, 2.5};
  volume.geometry.origin_mm = {-101.25, 33.5, 812.0625};
  volume.geometry.direction = glm::mat3_cast(glm::angleAxis(0.7, glm::normalize(Vec3(1, -2, 0.5))));
  return volume;
}

}  // namespace trephine::test
