// A small case for the shipped exercise, and the exercise's own script.
#pragma once

#include "base/system.h"
#include "session/session.h"
#include "shells.h"

namespace trephine::test {

// A ball of bone in scalp: enough of a cranium for the shipped exercise, and quick to make.
inline Volume smallHead() {
  return shells(80, 1.2, {{44, -20}, {39, 1200}, {32, 35}});
}

inline Exercise cranium() {
  return *readExercise(resourceFolder() / "scenes" / "cranium.json");
}

inline SessionOptions scripted(const std::filesystem::path& recording = {}) {
  const Exercise exercise = cranium();
  return {recording, *readOperatorScript(exercise.operator_file, exercise)};
}

}  // namespace trephine::test
