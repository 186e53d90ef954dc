// What every page, picture and export says.
#pragma once

namespace trephine {

inline constexpr const char* kPurpose = "For training, not for diagnosis or treatment planning";

}  // namespace trephine
