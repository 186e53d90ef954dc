// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kBadRecording{"BAD_RECORDING"};
inline constexpr Code kLetGo{"LET_GO"};
inline constexpr Code kNewerVersion{"NEWER_VERSION"};
inline constexpr Code kNotReplayable{"NOT_REPLAYABLE"};
inline constexpr Code kRecordingGone{"RECORDING_GONE"};
inline constexpr Code kStartsInTissue{"STARTS_IN_TISSUE"};
inline constexpr Code kTakesTooLong{"TAKES_TOO_LONG"};
inline constexpr Code kWrongCase{"WRONG_CASE"};
inline constexpr Code kWrongLabels{"WRONG_LABELS"};

}  // namespace trephine::code
