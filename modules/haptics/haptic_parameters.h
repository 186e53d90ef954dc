// What HapticCore is made of, which computes the ticks without devices: arms, laws, tissues.
// Checked as a whole before the loop's first tick (HapticLoop::startDevices), so that no tick
// checks it again.
#pragma once

#include <cstdint>
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

// Of an arm, with the one in hand: three other_tools at most.
constexpr std::size_t kMostTools = 4;

struct ArmParameters {
  Tool tool;  // in hand at first
  WorkspaceMap map;
  // The most that is sent to the arm, by length, at the device; to be set: 0.001 to 1000.
  double max_force_N = 0.0;
  ArmDynamics dynamics;
  std::vector<Tool> other_tools{};  // it may be given these: numbers 1 and on, `tool` is 0
};

struct HapticParameters {
  double period_s = 0.001;
  std::vector<ArmParameters> arms;  // at most kMaxArms
  // Each acts on every arm, and their forces add up (laws.h: acts()); empty: no force.
  std::vector<LawKind> laws;
  ForceAt force_at = ForceAt::tip;                      // law_input.h
  RemovalKind removal = RemovalKind::work;              // removal.h
  // Not 0: the seed paper's rule of touch, by points alone (contact.h), and its removal: the voxel
  // of each point that touches goes at once. A bit for each class of tissue that is touched.
  std::uint32_t touch_by_points = 0;
  bool removes = true;  // false: tissue is felt as it is, and none of it goes
  ControllerKind controller = ControllerKind::bounded;  // controllers.h
  TissueTable tissues;
  // Of the journal of cuts (volume/carve_journal.h), by which they are undone: in memory, 8 bytes
  // each; the rest in a file.
  std::size_t journal_voxels = 8'000'000;
  std::size_t journal_strokes = 65'536;  // once so many have begun, nothing more is cut
  // Of the session's beginning, to each of which one can rewind; to none after them.
  std::size_t journal_seconds = 86'400;
  double stroke_gap_s = 0.3;  // this long out of tissue ends a stroke
  // Touch as recordings of an older version have it, for replays of them.
  //  9: springs of dry friction beside the proxy's pull (laws/coulomb.h), and spheres for a driven
  //     tool thinner than a voxel's diagonal that its neighbours' rows hold (solid_surface.h);
  // 10: `bounded` without what version 11 added to it (bounded_controller.h), and the surface
  //     around a tool searched anew once any voxel goes (solid_surface.h).
  int touch_version = kTouchVersion;
};

// What of these is not as the seed paper's rule of touch has it, in a sentence; empty where all is.
std::string contradictsTouchByPoints(const std::vector<LawKind>& laws, ForceAt force_at,
                                     RemovalKind removal);
// What can be done then.
std::string besideTouchByPoints();

// Errors: IMPOSSIBLE_NUMBER of an arm's dynamics, map or max_force_N, of the period, or of a
// tissue; TOO_MANY_ARMS (kMaxArms, base/limits.h), TOO_MANY_TOOLS;
// CONTRADICTION of what does not go with touch_by_points. The tools' own numbers (tool.h)
// and those of the journal are not looked at.
Status validate(const HapticParameters& parameters);

}  // namespace trephine
