// One cell of the stability laboratory: an arm, a hand and a tissue in one dimension, simulated
// with one controller and judged. Pure: no window, clock, device or thread.
//
// The plant: m x'' = F(t - d T) + F_hand - c x',  F_hand = -k_h (x - x_r) - b_h x', with F held
// over each period T, integrated exactly (matrix exponential) between the parts of a period. The
// tissue fills x < 0. The tip starts 4 mm outside it, moving in at 0.05 m/s; the hand's rest point
// x_r moves from there to 6 mm inside during the first 0.3 s and stays, or swings. 2 s a cell if
// nothing else is said. The controller sees x rounded to the encoder's step, and nothing else.
#pragma once

#include <optional>
#include <vector>

#include "haptics/controllers.h"

namespace trephine {

struct StabilityCell {
  double mass_kg = 0.045;
  double period_s = 0.001;
  double delay_samples = 0.0;  // from a sample to the force that answers it; run in eighths
  double encoder_m = 0.0;
  double plant_damping = 0.05;  // N s/m
  Impedance hand;               // zero: nobody holds the arm
  Impedance tissue;             // stiffness zero: a damper
};

constexpr double kCellForce_N = 3.3;  // the arm's limit
constexpr double kCellDuration_s = 2.0;
constexpr double kCellRamp_s = 0.3;
constexpr double kCellStart_m = 0.004;
constexpr double kCellRest_m = -0.006;
constexpr double kCellSpeed_m_s = -0.05;
constexpr double kCellSwing_m = 0.004;  // either way
constexpr double kCellSwing_Hz = 1.0;

// What is done with a cell beside what it is.
struct CellConditions {
  double seconds = kCellDuration_s;
  bool moving = false;  // after the ramp the hand's rest point swings
  // What the controller is told of the arm: so many times its mass, so many samples more delay,
  // and, or not, an encoder that is exact.
  double mass_claimed = 1.0;
  int delay_claimed_more = 0;
  bool encoder_claimed_exact = false;
};

// Who answers the samples: a controller with the law f = -k x - b v (backward difference) inside
// the tissue, of which `tissue_scale` times the cell's b and k are left; the control of the bars,
// which never sends a force; or the continuous law itself, on the true state and without a bound
// but the arm's limit: what a perfect arm would do.
enum class CellDriver { off, seed, bounded, zero_force, ideal };

struct CellResult {
  // x less its centred 0.1 s mean, peak to peak, last quarter, and its mean frequency there. Under
  // a hand that swings the mean is taken off twice, which leaves 2 um of the swing itself.
  double oscillation_m = 0.0;
  double cycle_Hz = 0.0;
  double step_N = 0.0;          // mean |change| of the sent force a tick, last quarter
  double energy_out_J = 0.0;    // the most that the environment had ever given out, net
  double fidelity_error = 0.0;  // RMS (sent - ideal) over RMS ideal, on the true state; 0: no ideal
  double contact_rms_N = 0.0;   // RMS of the sent force while the tip was inside
  bool stable = true;
  bool not_as_stated = false;  // the controller says that the arm is not what was claimed of it
};

// What an encoder of this step cannot see [J].
double unseenEnergy_J(const StabilityCell& cell);
// What is too much, from the figures alone: an oscillation over 20 um and over two counts of the
// encoder, a step over 0.1 N, energy over unseenEnergy_J(). Not a number is too much.
struct CellFaults {
  bool oscillates = false, jumps = false, gives_out = false;
  bool any() const { return oscillates || jumps || gives_out; }
  // Whether each of these is among the other's.
  bool allIn(const CellFaults& o) const {
    return oscillates <= o.oscillates && jumps <= o.jumps && gives_out <= o.gives_out;
  }
};
CellFaults faultsOf(const StabilityCell& cell, const CellResult& result);
// None of the faults. CellResult::stable is this already.
bool isStable(const StabilityCell& cell, const CellResult& result);

CellResult runCell(const StabilityCell& cell, CellDriver driver, double tissue_scale = 1.0,
                   const CellConditions& conditions = {});

// What `off` does in a cell, on which the bars of the others rest.
struct CellReference {
  CellResult off;
  bool margin = false;  // `off` is stable, and also with b and k doubled
  // Largest scale of the tissue at which `off` is stable, where there is no margin and one above
  // 0.01 exists; RMS contact force there, and what the ideal law reaches of it.
  std::optional<double> scale;
  std::optional<double> contact_rms_N;
};
CellReference referenceOf(const StabilityCell& cell, double seconds = kCellDuration_s);

// Every combination of 3 masses, periods, delays, encoders and hands with 15 tissues: 3645 cells.
std::vector<StabilityCell> fullGrid();

}  // namespace trephine
