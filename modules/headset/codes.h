// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kBadMarks{"BAD_MARKS"};
inline constexpr Code kHeadsetEnded{"HEADSET_ENDED"};
inline constexpr Code kHeadsetFailed{"HEADSET_FAILED"};
inline constexpr Code kHeadsetInUse{"HEADSET_IN_USE"};
inline constexpr Code kHeadsetLost{"HEADSET_LOST"};
inline constexpr Code kNoGlx{"NO_GLX"};
inline constexpr Code kNoHeadset{"NO_HEADSET"};
inline constexpr Code kNoLoader{"NO_LOADER"};
inline constexpr Code kNoRuntime{"NO_RUNTIME"};
inline constexpr Code kTooFewMarks{"TOO_FEW_MARKS"};

}  // namespace trephine::code
