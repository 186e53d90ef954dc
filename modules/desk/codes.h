// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kArmsBusy{"ARMS_BUSY"};
inline constexpr Code kNotAsked{"NOT_ASKED"};

}  // namespace trephine::code
