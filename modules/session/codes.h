// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kMemoryNotLocked{"MEMORY_NOT_LOCKED"};
inline constexpr Code kOtherTissues{"OTHER_TISSUES"};

}  // namespace trephine::code
