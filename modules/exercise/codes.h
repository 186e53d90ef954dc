// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kBadScene{"BAD_SCENE"};
inline constexpr Code kLacksStructure{"LACKS_STRUCTURE"};
inline constexpr Code kLocked{"LOCKED"};
inline constexpr Code kNoLabels{"NO_LABELS"};
inline constexpr Code kNoPlace{"NO_PLACE"};
inline constexpr Code kNoSuchArm{"NO_SUCH_ARM"};
inline constexpr Code kNoSuchTissue{"NO_SUCH_TISSUE"};
inline constexpr Code kNoSurface{"NO_SURFACE"};
inline constexpr Code kPolicyUnreadable{"POLICY_UNREADABLE"};
inline constexpr Code kPolicyUnsafe{"POLICY_UNSAFE"};
inline constexpr Code kTissueNotFound{"TISSUE_NOT_FOUND"};

}  // namespace trephine::code
