// A case of the library as one works on it: its voxels and structures as a Case, and its own
// tissues.
#pragma once

#include <optional>
#include <string>

#include "case/case.h"
#include "library/case_library.h"
#include "tissue/tissue_set.h"

namespace trephine {

struct StoredCase {
  Case of;
  std::optional<TissueSet> tissues;
  // Why there are none, where that is no reason not to open the case: to be said once it is open.
  std::optional<Error> no_tissues{}, no_structures{};
};

// Errors: those of CaseLibrary::load(). Any thread.
Result<StoredCase> storedCase(CaseLibrary& library, const std::string& id,
                              const Progress& progress);

}  // namespace trephine
