// Where the set `rest` holds its tools: the shipped exercises' places, and blocks of each tissue.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "lab/touch/rest_measurement.h"

namespace trephine {

// One run: every arm of a core on its path.
struct HoldCell {
  std::string exercise, place;
  std::vector<std::string> arms, tools;
  HapticParameters parameters;
  std::shared_ptr<const Volume> volume;
  std::shared_ptr<const LabelMap> labels{};  // for tissues of a structure
  std::vector<RigArm> rig;
  std::vector<HoldPath> paths;
};

// Errors: those of the shipped exercises' files, cases and devices, CANCELLED.
Result<std::vector<HoldCell>> restPlaces(const Progress& progress);

}  // namespace trephine
