// The codes of the errors, findings and choices that begin here.
#pragma once

#include "base/code.h"

namespace trephine::code {

inline constexpr Code kBadPicture{"BAD_PICTURE"};
inline constexpr Code kBadToolFrame{"BAD_TOOL_FRAME"};
inline constexpr Code kMeshEmpty{"MESH_EMPTY"};
inline constexpr Code kMeshNotFinite{"MESH_NOT_FINITE"};
inline constexpr Code kMeshTooFar{"MESH_TOO_FAR"};
inline constexpr Code kMeshTooLarge{"MESH_TOO_LARGE"};
inline constexpr Code kNoDisplay{"NO_DISPLAY"};
inline constexpr Code kVolumeRefused{"VOLUME_REFUSED"};

}  // namespace trephine::code
