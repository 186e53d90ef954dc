// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kBadCrop{"BAD_CROP"};
inline constexpr Code kBadFactor{"BAD_FACTOR"};
inline constexpr Code kBadGeometry{"BAD_GEOMETRY"};
inline constexpr Code kBadNames{"BAD_NAMES"};
inline constexpr Code kBadSize{"BAD_SIZE"};
inline constexpr Code kDamaged{"DAMAGED"};
inline constexpr Code kFormsDiffer{"FORMS_DIFFER"};
inline constexpr Code kLabelsElsewhere{"LABELS_ELSEWHERE"};
inline constexpr Code kNotHu{"NOT_HU"};
inline constexpr Code kNotLabels{"NOT_LABELS"};
inline constexpr Code kNoSidecar{"NO_SIDECAR"};
inline constexpr Code kOtherGrid{"OTHER_GRID"};
inline constexpr Code kTooManyStructures{"TOO_MANY_STRUCTURES"};
inline constexpr Code kUnknownFormat{"UNKNOWN_FORMAT"};
inline constexpr Code kUnknownPhantom{"UNKNOWN_PHANTOM"};
inline constexpr Code kUnreadable{"UNREADABLE"};

}  // namespace trephine::code
