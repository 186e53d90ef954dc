// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kBadOption{"BAD_OPTION"};
inline constexpr Code kNotAnswered{"NOT_ANSWERED"};
inline constexpr Code kNotCommissioned{"NOT_COMMISSIONED"};
inline constexpr Code kNotHeld{"NOT_HELD"};
inline constexpr Code kNotMeasured{"NOT_MEASURED"};
inline constexpr Code kNotTried{"NOT_TRIED"};
inline constexpr Code kNoArms{"NO_ARMS"};
inline constexpr Code kNoNormalPriority{"NO_NORMAL_PRIORITY"};
inline constexpr Code kNoRealTime{"NO_REAL_TIME"};

}  // namespace trephine::code
