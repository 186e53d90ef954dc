// Why the loader of OpenXR finds no runtime.
#pragma once

#include <string>

#include "base/result.h"

namespace trephine {

// NO_RUNTIME: none is active, said of `where`, or the active one, whose manifest is named, is
// broken: to the loader one that is broken is none.
Error noActiveRuntime(const std::string& where);

}  // namespace trephine
