// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kBadTissue{"BAD_TISSUE"};
inline constexpr Code kLastTissue{"LAST_TISSUE"};
inline constexpr Code kNoRoom{"NO_ROOM"};

}  // namespace trephine::code
