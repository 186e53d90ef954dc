// A small case for the shipped scene, and the scene's own script.
#pragma once

#include "base/system.h"
#include "session/session.h"

namespace trephine::test {

// A ball of bone in scalp: enough of a cranium for the shipped scene, and quick to make.
inline Volume smallHead() {
  Volume v;
  GridGeometry& g = v.geometry;
  g.size = {80, 80, 80};
  g.spacing_mm = Vec3(1.2);
  g.origin_mm = Vec3(-47.4);
  v.hu.assign(g.voxelCount(), kAirHu);
  for (std::size_t i = 0; i < v.hu.size(); ++i) {
    const Index3 ijk = g.indicesOf(i);
    const double r = glm::length(g.toPatient_mm(Vec3(ijk[0], ijk[1], ijk[2])));
    if (r < 44) v.hu[i] = -20;
    if (r < 39) v.hu[i] = 1200;
    if (r < 32) v.hu[i] = 35;
  }
  return v;
}

inline Scene cranium() {
  return *readScene(resourceFolder() / "scenes" / "cranium.json");
}

inline SessionOptions scripted(const std::filesystem::path& recording = {}) {
  const Scene scene = cranium();
  return {recording, *readOperatorScript(scene.operator_file, scene)};
}

}  // namespace trephine::test
