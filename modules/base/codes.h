// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kBadArgument{"BAD_ARGUMENT"};
inline constexpr Code kBadField{"BAD_FIELD"};
inline constexpr Code kBadJson{"BAD_JSON"};
inline constexpr Code kBadPin{"BAD_PIN"};
inline constexpr Code kBadState{"BAD_STATE"};
inline constexpr Code kBusy{"BUSY"};
inline constexpr Code kCancelled{"CANCELLED"};
inline constexpr Code kCannotRead{"CANNOT_READ"};
inline constexpr Code kCannotRun{"CANNOT_RUN"};
inline constexpr Code kCannotWrite{"CANNOT_WRITE"};
inline constexpr Code kEmptyStructure{"EMPTY_STRUCTURE"};
inline constexpr Code kImpossibleNumber{"IMPOSSIBLE_NUMBER"};
inline constexpr Code kMissingFile{"MISSING_FILE"};
inline constexpr Code kMissingFolder{"MISSING_FOLDER"};
inline constexpr Code kNotStl{"NOT_STL"};
inline constexpr Code kNoFile{"NO_FILE"};
inline constexpr Code kNoOpengl{"NO_OPENGL"};
inline constexpr Code kNoRandomNumbers{"NO_RANDOM_NUMBERS"};
inline constexpr Code kNoStructure{"NO_STRUCTURE"};
inline constexpr Code kNoTemporaryFolder{"NO_TEMPORARY_FOLDER"};
inline constexpr Code kOlderVersion{"OLDER_VERSION"};
inline constexpr Code kOutOfMemory{"OUT_OF_MEMORY"};
inline constexpr Code kTooLarge{"TOO_LARGE"};
inline constexpr Code kUnexpected{"UNEXPECTED"};
inline constexpr Code kWriteFailed{"WRITE_FAILED"};

}  // namespace trephine::code
