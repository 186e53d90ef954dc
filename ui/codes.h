// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kCaseNotSaved{"CASE_NOT_SAVED"};
inline constexpr Code kMissingCase{"MISSING_CASE"};
inline constexpr Code kNotVerified{"NOT_VERIFIED"};
inline constexpr Code kNoOperator{"NO_OPERATOR"};
inline constexpr Code kNoScreen{"NO_SCREEN"};
inline constexpr Code kStopped{"STOPPED"};

}  // namespace trephine::code
