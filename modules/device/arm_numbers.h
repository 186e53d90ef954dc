// What an arm says of itself: a row each, for the check of a plugin's answer, the README and the
// test that holds the simulated arms' own table against it.
#pragma once

#include <cstddef>
#include <string>

#include "base/field.h"
#include "base/tr.h"
#include "device/arm_ranges.h"
#include "device/trephine_device.h"

namespace trephine {

// A number or, for each axis, numbers of TrephineCapabilities.
struct CapabilityNumber {
  FieldRow row;
  std::size_t offset;
  std::size_t count = 1;

  double value(const TrephineCapabilities& of, std::size_t index = 0) const;
};

inline constexpr CapabilityNumber kCapabilityNumbers[] = {
    {{"workspace_m", kWorkspace_m, Given::always,
      trLater("full extent of x, y and z around the origin")},
     offsetof(TrephineCapabilities, workspace_m),
     3},
    {{"peak_force_N", kPeakForce_N, Given::always,
      trLater("the clamp: no more is sent, whatever the scene says")},
     offsetof(TrephineCapabilities, peak_force_N)},
    {{"continuous_force_N", kPeakForce_N, Given::always,
      trLater("what is sent for good: the limit falls to it as the motors warm")},
     offsetof(TrephineCapabilities, continuous_force_N)},
    {{"thermal_s", kThermal_s, Given::always,
      trLater("the time constant with which they warm; 0: the arm looks after itself")},
     offsetof(TrephineCapabilities, thermal_s)},
    {{"apparent_mass_kg", kApparentMass_kg, Given::always, trLater("what `bounded` goes by")},
     offsetof(TrephineCapabilities, apparent_mass_kg)},
    {{"rate_hz", kDeviceRate_hz, Given::always,
      trLater("of its samples; a scene that asks for more is refused")},
     offsetof(TrephineCapabilities, rate_hz)},
    {{"encoder_step_m", kEncoderStep_m, Given::always,
      trLater("what `bounded` goes by; 0: finer than it sees")},
     offsetof(TrephineCapabilities, encoder_step_m)},
    {{"latency_s", kLatency_s, Given::always,
      trLater("from a sample to the force that answers it, p99; what `bounded` goes by")},
     offsetof(TrephineCapabilities, latency_s)},
    {{"friction_N", kDryFriction_N, Given::always,
      trLater("what it takes to move it by hand: a weaker force is not felt; 0: not known")},
     offsetof(TrephineCapabilities, friction_N)},
};

// `input_dof` beside these: 6, 3, or 0 for a pedal, which has a rate alone.
// Empty when an arm can have these capabilities, else which of them is impossible and why.
std::string impossibleCapability(const TrephineCapabilities& capabilities);

// The table of modules/device/README.md.
std::string capabilityPage();

}  // namespace trephine
