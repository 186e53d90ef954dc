// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kCannotDraw{"CANNOT_DRAW"};

}  // namespace trephine::code
