// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kBadDeviceConfig{"BAD_DEVICE_CONFIG"};
inline constexpr Code kBadPlugin{"BAD_PLUGIN"};
inline constexpr Code kDeviceNotStarted{"DEVICE_NOT_STARTED"};
inline constexpr Code kDeviceStuck{"DEVICE_STUCK"};
inline constexpr Code kNoBench{"NO_BENCH"};
inline constexpr Code kNoDevice{"NO_DEVICE"};
inline constexpr Code kNoPlugin{"NO_PLUGIN"};
inline constexpr Code kNotCalibrated{"NOT_CALIBRATED"};
inline constexpr Code kTwoPlugins{"TWO_PLUGINS"};

}  // namespace trephine::code
