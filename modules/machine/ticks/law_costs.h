// What each law and each controller of an exercise costs a tick on this machine: the first arm's
// tool slides in the firmest of the exercise's tissues.
#pragma once

#include <utility>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "exercise/exercise.h"

namespace trephine {

struct LawCosts {
  double tick_ns = 0.0;  // as the exercise is, one arm
  // What a tick with it takes more than one without it, the exercise's other laws as they are: the
  // median of the rounds' differences, and half of what the middle half of them spans.
  std::vector<std::pair<LawKind, double>> law_ns;
  double noise_ns = 0.0;  // of the noisiest law: what is less is not measured
  bool touched = false;   // each tool was in the tissue, with its force
  // A tick's time with it.
  std::vector<std::pair<ControllerKind, double>> controller_ns;
};

// Medians of rounds in which all take their turns, so that a busy moment is everybody's. A second
// or two. Errors: CANCELLED, BAD_SCENE where it has no arm, no tool or no tissue.
Result<LawCosts> measureLawCosts(const Exercise& exercise, const Progress& progress = Progress());

}  // namespace trephine
