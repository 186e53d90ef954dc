// Rows of `trephine-measure extremes` on touch that holds: a tool that cannot cut stays out of
// bone, rests, keeps its stiffness and gets its force back. Real tools of the shipped exercises on
// TouchRig.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "lab/touch/extremes_measurement.h"
#include "lab/touch/touch_rig.h"

namespace trephine {

// Bone alone, 226 HU and more, with the cranium's own mechanics.
TissueTable boneOnly(bool cuttable);

// A hand of this stiffness that pushes a tool along `push` into bone, which begins at `surface_mm`.
struct Press {
  Vec3 surface_mm{0.0}, push{0.0, 0.0, -1.0};
  double force_N = 1.0, hand_N_per_m = 300.0;
  double tilt_rad = 0.0;  // of the tool against its push
  bool moves = false;     // turned by 20 degrees and dragged aside by 5 mm, to and fro, from 3 s on
  bool at_edge = false;   // of what is pressed on
};
struct PressResult {
  double inside_mm = 0.0;  // the most that the tool, at its proxy, was inside bone
  // The most that the arm was beyond its proxy, of what the push allows, in the second half, where
  // the push was within the arm's limit and the tool did not slip, nor was just caught.
  double beyond_mm = 0.0, beyond_share = 0.0;
  double push_N = 0.0, learnt = 1.0;  // then: the hand's, and the controller's scale
  bool held = false;
};
PressResult pressInto(const Tool& tool, const TissueTable& tissues, const Volume& volume,
                      const Press& press, double seconds = 10.0);

// How far a tool at this pose is inside bone: of the voxels' centres within its body the deepest,
// and how far from it the surface is, where HU crosses the tissue's between it and its neighbours.
double insideSolid_mm(const Tool& tool, const Pose& pose_mm, const Grid& grid, int hu_from);

// `case_source`: a real skull for the barrier as well; empty: none. Errors: those of the exercises'
// files and devices and of the case, CANCELLED.
Result<std::vector<ExtremeRow>> measureTouchExtremes(const std::string& case_source,
                                                     const Progress& progress);

}  // namespace trephine
