// Exercises that ship, as they are and as text.
#pragma once

#include "base/system.h"
#include "exercise/exercise.h"

namespace trephine::test {

inline std::filesystem::path burrHoleFile() {
  return resourceFolder() / "scenes" / "burr-hole.json";
}
inline Json burrHole() { return *readJsonFile(burrHoleFile()); }

}  // namespace trephine::test
