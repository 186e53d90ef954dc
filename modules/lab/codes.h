// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kHeadsetStuck{"HEADSET_STUCK"};

}  // namespace trephine::code
