// Where the set `rest` holds its tools: the shipped exercises' places, blocks of each
// tissue, and edges of bone.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "lab/touch/rest_measurement.h"

namespace trephine {

// One run, as hold() (rest_measurement.h) takes it: all arms at once, simulated. `arms`, `tools`,
// `rig` and `paths` have one an arm, in the same order.
struct HoldCell {
  std::string exercise, place;
  std::vector<std::string> arms, tools;
  HapticParameters parameters;
  std::shared_ptr<const Volume> volume;
  std::shared_ptr<const LabelMap> labels{};  // for tissues of a structure
  std::vector<RigArm> rig;
  std::vector<HoldPath> paths;
  std::vector<HoldKind> kinds{HoldKind::rest, HoldKind::swing, HoldKind::creep};
};

// From the program's resources. It reads their cases, and the cells keep all volumes in memory.
// Errors: those of the shipped exercises' files, cases and (simulated) devices, CANCELLED.
Result<std::vector<HoldCell>> restPlaces(const Progress& progress);

}  // namespace trephine
