// What each law and each controller of a scene costs a tick on this machine: the first arm's tool
// slides in the firmest of the scene's tissues.
#pragma once

#include <utility>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "scene/scene.h"

namespace trephine {

struct LawCosts {
  double tick_ns = 0.0;  // as the scene is, one arm
  // What a tick with it takes more than one without it, the scene's other laws as they are: the
  // median of the rounds' differences, and half of what the middle half of them spans.
  std::vector<std::pair<LawKind, double>> law_ns;
  double noise_ns = 0.0;  // of the noisiest law: what is less is not measured
  bool touched = false;   // each tool was in the tissue, with its force
  // A tick's time with it.
  std::vector<std::pair<ControllerKind, double>> controller_ns;
};

// Medians of rounds in which all take their turns, so that a busy moment is everybody's. A second or
// two. Errors: CANCELLED, BAD_SCENE where it has no arm, no tool or no tissue.
Result<LawCosts> measureLawCosts(const Scene& scene, const Progress& progress = Progress());

}  // namespace trephine
