// What an arm is to the force that it shows: the few numbers on which stability depends, with a row
// each.
#pragma once

#include "base/field.h"
#include "base/tr.h"
#include "device/arm_ranges.h"
#include "haptics/workspace_map.h"

namespace trephine {

struct ArmDynamics {
  double apparent_mass_kg = 0.045;
  double encoder_step_m = 0.0;  // 0: samples count as exact
  double peak_force_N = 3.3;
  // From a sample to the moment in which the force that answers it begins to act and to be held
  // for a period: 0 for an arm that takes its force at once.
  double delay_s = 0.0;
  // What it can be sent for good, and with which time constant its motors warm; 0 s: it looks after
  // itself (device_rules.h).
  double continuous_force_N = 3.3;
  double thermal_s = 0.0;
  // Its own, dry: no part of the tick goes by it, but it hides what is weaker. 0: not known.
  double friction_N = 0.0;
  bool operator==(const ArmDynamics&) const = default;
};

constexpr int kMaxDelayTicks = 16;  // periods, at any rate
constexpr Range kDelaySamples{0, kMaxDelayTicks, "samples"};
constexpr Range kDelay_s{0, 0.16, "s"};
// The delay in periods; one that is whole but for rounding is whole.
double delaySamples(const ArmDynamics& arm, double period_s);

// Those that a recording keeps; the peak force is the exercise's `max_force_N`.
inline constexpr FieldOf<ArmDynamics> kArmDynamicsFields[] = {
    {{"apparent_mass_kg", kApparentMass_kg, Given::always, trLater("at the tip")},
     &ArmDynamics::apparent_mass_kg},
    {{"encoder_step_m", kEncoderStep_m, Given::always, trLater("of its position")},
     &ArmDynamics::encoder_step_m},
    {{"delay_s", kDelay_s, Given::may_be, trLater("from a sample to the force that answers it")},
     &ArmDynamics::delay_s},
    {{"continuous_force_N", kPeakForce_N, Given::may_be, trLater("what it can be sent for good")},
     &ArmDynamics::continuous_force_N},
    {{"thermal_s", kThermal_s, Given::may_be,
      trLater("the time constant with which its motors warm; 0: it looks after itself")},
     &ArmDynamics::thermal_s},
    {{"friction_N", kDryFriction_N, Given::may_be,
      trLater("what it takes to move it by hand; 0: not known")},
     &ArmDynamics::friction_N},
};
inline constexpr FieldRow kArmPeakForce{"peak_force_N", kPeakForce_N, Given::always,
                                        trLater("no more is sent")};

// IMPOSSIBLE_NUMBER. What an arm is made of is checked where it comes from (a device's answer, a
// file, and all of it once more before the loop's first tick): nothing later asks again.
Status validate(const ArmDynamics& arm, const std::string& of);

// Damping [N s/m] and stiffness [N/m] of a tissue.
struct Impedance {
  double damping = 0.0;
  double stiffness = 0.0;
};

// The firmest tissue that `bounded` shows on this arm at this rate: a firmer one is felt as this
// much (k 10.6 times as high as contact begins, fading with 5.25 ms). In the patient's metres: the
// map's motion scale s and force scale g are divided out, since a tissue's b and k are g s b and g
// s k at the arm. Source of the numbers: CONTROLLERS.md, part 1.
struct Renderable {
  double b_max = 0.0;  // N s/m
  double k_max = 0.0;  // N/m
};
Renderable renderable(const ArmDynamics& arm, double rate_hz, double delay_samples,
                      const WorkspaceMap& map);

}  // namespace trephine
