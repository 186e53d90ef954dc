// The set `rest` of the stability laboratory: tools that hands hold in tissue. Not a cell in one
// dimension but the real core with its proxy, laws, controller and output limiter, in two kinds of
// places:
//   exercises   the shipped exercises that are not the seed paper's, in their built-in case, all
//   arms at
//            once: where the hands' devices have their origins, and pressed into each tissue that
//            lies before the first solid one and into that, beside each other, by hands of 300, 600
//            and 1000 N/m;
//   blocks   each tool, sum of laws, tissue and arm once: pressed into a block of the tissue;
//            and, by maps that scale the force by 10 and 100, as edges are;
//   edges    each tool on an edge, a corner, a ridge and a comb of bone, at places across it, with
//            0.3 and 1 N by hands of 50, 300 and 600 N/m: at rest alone, once it has slid to where
//            it stays.
// Hands come from outside, motors are off, and a tool that cuts by hand meanwhile is said so. Each
// is held still for a minute, `rest`; swung to and fro by 4 mm at 1 Hz along the press, `swing`;
// and drawn across it at 0.2 mm/s, `creep`. Of a rest is judged
//   cycle       what is left of the arm's true position above 2 Hz (less its centred mean over
//               0.5 s), peak to peak over the minute: over 20 um and over a count of the encoder;
//   energy      the most that the arm had ever given out, net, as a session reports it: over 0.2
//   mJ; at an edge, where it slides, on where the arm truly was and from then on: what press and
//   slide put in hides nothing;
// and of the others the same beyond the motion itself (less its centred 0.1 s mean, twice), at the
// bars of a cell under a moving hand (stability_cell.h) and as there where the arm truly was: a
// count that is passed under force adds up to k q^2 that nobody gave out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "lab/touch/touch_rig.h"

namespace trephine {

enum class HoldKind { rest, swing, creep, edge };

// Where one hand is: from `start` to `held`, and there it stays, swings by +-`swing` or creeps
// across it.
struct HoldPath {
  Vec3 start_m{0.0}, held_m{0.0}, swing_m{0.0};  // device axes
};

// What became of an arm that was held.
struct HoldResult {
  double cycle_m = 0.0, cycle_Hz = 0.0, energy_out_J = 0.0;
  bool touched = false;              // while it was judged
  bool waited = false;               // it began in tissue: nothing was felt
  std::uint64_t removed_voxels = 0;  // while it was judged
  double shown = 1.0;  // of the demanded force was sent, on average, while it was judged
  double demanded_N = 0.0;  // on average
};
struct HoldFaults {
  bool cycles = false, gives_out = false;
  bool any() const { return cycles || gives_out; }
  bool allIn(const HoldFaults& o) const { return cycles <= o.cycles && gives_out <= o.gives_out; }
};
HoldFaults faultsOf(HoldKind kind, const HoldResult& result, double encoder_m);
// Beyond what is accepted of a rest anywhere: two counts of the encoder, 0.5 mJ.
bool isGrave(HoldKind kind, const HoldResult& result, double encoder_m);

// Every arm on its path, judged for so long from 3 s after it arrived, at an edge from 8 s.
// `ideal`: the continuous law on perfect arms: no controller, no encoder, 5 kHz. `labels`: for
// tissues of a structure.
std::vector<HoldResult> hold(HapticParameters parameters, const Volume& volume,
                             std::vector<RigArm> arms, const std::vector<HoldPath>& paths,
                             HoldKind kind, double seconds, bool ideal = false,
                             const std::shared_ptr<const LabelMap>& labels = nullptr);

struct RestRow {
  std::string exercise, arm, tool, place;
  HoldKind kind = HoldKind::rest;
  HoldResult result;
  double encoder_m = 0.0;
  bool unstable = false, also_ideal = false;
};
struct RestFigures {
  std::vector<RestRow> rows;
  double seconds = 0.0;  // of a rest
};

constexpr double kRest_s = 60.0;
// What is shown of a force says something from here on.
constexpr double kWorthShowing_N = 0.05;
// Errors: those of the shipped exercises' files and devices, CANCELLED.
Result<RestFigures> measureRest(std::optional<double> seconds, const Progress& progress);

// {cells, unstable, also_ideal, energy_out_mJ_max, cycle_um_max, cycle_Hz, beyond_accepted,
// cutting,
//  kinds: [{name, ...}], rows: [{exercise, arm, tool, place, kind, cycle_um, cycle_Hz,
//  energy_out_mJ, shown, demanded_N, unstable, also_ideal, cuts}]}; least_shown of those that
//  demand at least kWorthShowing_N
Json toJson(const RestFigures& figures);
std::string toText(const RestFigures& figures);

}  // namespace trephine
