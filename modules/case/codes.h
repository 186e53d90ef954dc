// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kNoCase{"NO_CASE"};
inline constexpr Code kNoLandmark{"NO_LANDMARK"};
inline constexpr Code kNoVault{"NO_VAULT"};
inline constexpr Code kOtherAnatomy{"OTHER_ANATOMY"};

}  // namespace trephine::code
