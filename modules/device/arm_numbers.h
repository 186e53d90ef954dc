// What an arm says of itself: a row each, for the check of a plugin's answer, the README and the
// test that holds the simulated arms' own table against it.
#pragma once

#include <cstddef>
#include <string>

#include "base/number_row.h"
#include "device/arm_ranges.h"
#include "device/trephine_device.h"

namespace trephine {

// A number or, for each axis, numbers of TrephineCapabilities.
struct CapabilityNumber {
  NumberRow row;
  std::size_t offset;
  std::size_t count = 1;

  double value(const TrephineCapabilities& of, std::size_t index = 0) const;
};

inline constexpr CapabilityNumber kCapabilityNumbers[] = {
    {{"workspace_m", kWorkspace_m, Given::always, "full extent of x, y and z around the origin"},
     offsetof(TrephineCapabilities, workspace_m),
     3},
    {{"peak_force_N", kPeakForce_N, Given::always,
      "the clamp: no more is sent, whatever the scene says"},
     offsetof(TrephineCapabilities, peak_force_N)},
    {{"continuous_force_N", kPeakForce_N, Given::always, "reported; nothing here reads it"},
     offsetof(TrephineCapabilities, continuous_force_N)},
    {{"apparent_mass_kg", kApparentMass_kg, Given::always, "what `bounded` goes by"},
     offsetof(TrephineCapabilities, apparent_mass_kg)},
    {{"rate_hz", kDeviceRate_hz, Given::always,
      "the highest rate of its samples; a scene that asks for more is refused"},
     offsetof(TrephineCapabilities, rate_hz)},
    {{"max_stiffness_N_per_m", kMaxStiffness_N_per_m, Given::always,
      "the maker's; reported; nothing here reads it, below"},
     offsetof(TrephineCapabilities, max_stiffness_N_per_m)},
    {{"max_damping_Ns_per_m", kMaxDamping_Ns_per_m, Given::always,
      "the maker's; reported; nothing here reads it, below"},
     offsetof(TrephineCapabilities, max_damping_Ns_per_m)},
    {{"encoder_step_m", kEncoderStep_m, Given::always,
      "what `bounded` goes by; 0: finer than it sees"},
     offsetof(TrephineCapabilities, encoder_step_m)},
    {{"latency_s", kLatency_s, Given::always,
      "from a sample to the force that answers it, p99; what `bounded` goes by"},
     offsetof(TrephineCapabilities, latency_s)},
};

// Empty when an arm can have these capabilities, else which of them is impossible and why.
std::string impossibleCapability(const TrephineCapabilities& capabilities);

// The table of modules/device/README.md.
std::string capabilityPage();

}  // namespace trephine
