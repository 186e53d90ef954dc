// A small case for the shipped scene, and the scene's own script.
#pragma once

#include "base/system.h"
#include "session/session.h"
#include "shells.h"

namespace trephine::test {

// A ball of bone in scalp: enough of a cranium for the shipped scene, and quick to make.
inline Volume smallHead() {
  return shells(80, 1.2, {{44, -20}, {39, 1200}, {32, 35}});
}

inline Scene cranium() {
  return *readScene(resourceFolder() / "scenes" / "cranium.json");
}

inline SessionOptions scripted(const std::filesystem::path& recording = {}) {
  const Scene scene = cranium();
  return {recording, *readOperatorScript(scene.operator_file, scene)};
}

}  // namespace trephine::test
