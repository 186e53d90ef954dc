// A block of tissue in layers, a tool on a prescribed way, and the force that the laws demand: the
// real loop, core and device host around an arm that answers from a script.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "haptics/haptic_types.h"
#include "haptics/laws.h"
#include "haptics/removal.h"
#include "haptics/tool.h"
#include "tissue/tissue_set.h"

namespace trephine {

// Layers lie on top of each other; the surface of the first is the plane z = 0, and tissue is
// below. A tool points down.
struct TissueLayer {
  Tissue tissue;
  double thick_mm = 0.0;
};

// A hand that is no rail: it pulls the arm to the way by a spring, or pushes it down with a steady
// force instead. The arm is a mass with a little damping.
struct TissueHand {
  double stiffness_N_per_m = 1000.0, damping_Ns_per_m = 10.0;
  double push_N = 0.0;  // above 0: along x and y the spring holds it, down it is pushed
  double mass_kg = 0.045;
};

struct TissueStroke {
  std::vector<TissueLayer> layers;  // from the top
  double spacing_mm = 0.5;
  double wide_mm = 30.0;  // of the block along x; along y a third of it, 12 mm at least
  Tool tool;
  std::vector<LawKind> laws;
  // The arm's tip, patient axes [mm], at a time [s] from 0 to `seconds`.
  std::function<Vec3(double t_s)> way;
  double seconds = 1.0;
  std::optional<TissueHand> hand{};  // nothing: the arm is where the way is
  double rate_hz = 1000.0;
  double peak_force_N = 3.3;  // of the arm
  double force_scale = 1.0;
  RemovalKind removal = RemovalKind::work;
  ControllerKind controller = ControllerKind::bounded;
};

struct TissueSample {
  double t_s = 0.0;
  Vec3 arm_mm{0.0}, tool_mm{0.0};
  Vec3 demanded_N{0.0};  // on the arm, patient axes, before its limit and scale
  Vec3 sent_N{0.0};      // at the device
  std::int32_t removed_voxels = 0;
};

struct TissueTrace {
  std::vector<TissueSample> samples;  // a tick each
  std::vector<CarveRecord> carves;
  double removed_mm3 = 0.0;
};

// Errors: BAD_ARGUMENT; those of the loop.
Result<TissueTrace> runStroke(const TissueStroke& stroke);

// The stroke goes through these places at a steady speed.
void goThrough(TissueStroke& stroke, const std::vector<Vec3>& places_mm, double mm_per_s);
// So, by the laws of soft tissue, through a block 16 mm wide on an arm of 20 N.
TissueStroke softStroke(std::vector<TissueLayer> layers, const Tool& tool,
                        const std::vector<Vec3>& places_mm, double mm_per_s);
Tool needleOf(double width_mm, int points = 1);  // 60 mm long
// How high the arm is when it is first pushed up, patient z; 0 where it never is.
double firstTouch_mm(const std::vector<TissueSample>& samples);

}  // namespace trephine
