// A case of the library as the window works on it.
#pragma once

#include <string>

#include "library/case_library.h"
#include "ui/work/workstation.h"

namespace trephine {

// In the background.
Result<Workstation::Stored> storedCase(CaseLibrary& library, const std::string& id,
                                       const Progress& progress);

}  // namespace trephine
