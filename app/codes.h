// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kBadUse{"BAD_USE"};
inline constexpr Code kInternal{"INTERNAL"};
inline constexpr Code kNoStorage{"NO_STORAGE"};
inline constexpr Code kNotInstalled{"NOT_INSTALLED"};

}  // namespace trephine::code
