// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kBadName{"BAD_NAME"};
inline constexpr Code kCannotReach{"CANNOT_REACH"};
inline constexpr Code kCaseChanged{"CASE_CHANGED"};
inline constexpr Code kCasePartMissing{"CASE_PART_MISSING"};
inline constexpr Code kNameIsIdentity{"NAME_IS_IDENTITY"};
inline constexpr Code kNameTaken{"NAME_TAKEN"};
inline constexpr Code kNameUnchecked{"NAME_UNCHECKED"};
inline constexpr Code kNotAStorage{"NOT_A_STORAGE"};
inline constexpr Code kNotRoot{"NOT_ROOT"};
inline constexpr Code kNoGroup{"NO_GROUP"};
inline constexpr Code kNoSuchCase{"NO_SUCH_CASE"};
inline constexpr Code kNoTissues{"NO_TISSUES"};
inline constexpr Code kWrongGrid{"WRONG_GRID"};

}  // namespace trephine::code
