// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kBadSeed{"BAD_SEED"};
inline constexpr Code kNothingGrown{"NOTHING_GROWN"};
inline constexpr Code kNothingThere{"NOTHING_THERE"};
inline constexpr Code kNoBody{"NO_BODY"};
inline constexpr Code kNoBone{"NO_BONE"};

}  // namespace trephine::code
