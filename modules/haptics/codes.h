// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kBadTool{"BAD_TOOL"};
inline constexpr Code kContradiction{"CONTRADICTION"};
inline constexpr Code kTooManyArms{"TOO_MANY_ARMS"};
inline constexpr Code kTooManyTools{"TOO_MANY_TOOLS"};

}  // namespace trephine::code
