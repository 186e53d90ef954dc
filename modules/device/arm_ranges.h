// What an arm may be and say of itself; what lies beyond is refused as a fault of the plugin or
// file.
#pragma once

#include "base/range.h"

namespace trephine {

constexpr Range kApparentMass_kg{1e-4, 100, "kg"};
constexpr Range kEncoderStep_m{0, 0.01, "m"};
constexpr Range kWorkspace_m{1e-3, 10, "m"};  // full extent along an axis
constexpr Range kPeakForce_N{1e-3, 1000, "N"};
constexpr Range kThermal_s{0, 3600, "s"};
constexpr Range kDeviceRate_hz{1, 1e6, "Hz"};
constexpr Range kLatency_s{0, 0.1, "s"};
constexpr Range kDryFriction_N{0, 10, "N"};
// Of an arm's pose, along an axis from its origin: beyond any arm, and near enough that all that
// follows from it is finite.
constexpr Range kPosePlace_m{-1e4, 1e4, "m"};
constexpr int kMaxArmsOfAPlugin = 64;

}  // namespace trephine
