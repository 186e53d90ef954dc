// What the core is made of: arms, laws, tissues. Checked as a whole before the loop's first tick
// (HapticLoop::startDevices), so that no tick checks it again.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "haptics/arm_dynamics.h"
#include "haptics/controllers.h"
#include "haptics/laws.h"
#include "haptics/removal.h"
#include "haptics/tool.h"
#include "haptics/workspace_map.h"
#include "tissue/tissue_set.h"

namespace trephine {

constexpr std::size_t kMostTools = 4;  // of an arm

struct ArmParameters {
  Tool tool;  // in hand at first
  WorkspaceMap map;
  double max_force_N = 0.0;
  ArmDynamics dynamics;
  std::vector<Tool> other_tools{};  // it may be given these: numbers 1 and on, `tool` is 0
};

struct HapticParameters {
  double period_s = 0.001;
  std::vector<ArmParameters> arms;  // at most kMaxArms
  std::vector<LawKind> laws;
  ForceAt force_at = ForceAt::tip;
  RemovalKind removal = RemovalKind::work;
  ControllerKind controller = ControllerKind::bounded;
  TissueTable tissues;
  std::size_t journal_voxels = 8'000'000;  // in memory, 8 bytes each; the rest in a file
  std::size_t journal_strokes = 65'536;
  std::size_t journal_seconds = 86'400;  // to which one can rewind
  double stroke_gap_s = 0.3;             // this long out of tissue ends a stroke
};

// Errors: IMPOSSIBLE_NUMBER of an arm's dynamics, map or limit, of the period, or of a tissue;
// TOO_MANY_ARMS, TOO_MANY_TOOLS.
Status validate(const HapticParameters& parameters);

}  // namespace trephine
