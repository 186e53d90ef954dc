// What every page, picture and export says.
#pragma once

#include "base/tr.h"

namespace trephine {

inline constexpr const char* kPurpose =
    trLater("For training, not for diagnosis or treatment planning");

}  // namespace trephine
