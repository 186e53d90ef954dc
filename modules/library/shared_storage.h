// A storage folder for several accounts of one machine.
//
//   STORAGE/             readers: go in and look
//   STORAGE/cases, exercises, tissues, .parts, .lock   writers: change; readers: look
//   STORAGE/private/     each writer what is his own (name_guard.h)
//   STORAGE/sessions/    each account what is its own; writers: look
#pragma once

#include <filesystem>
#include <string>

#include "base/result.h"

namespace trephine {

struct StorageGroups {
  std::string readers = "trephine", writers = "trephine-teach";
};

// Makes what is missing, and gives all of it, with what is in it already, to root and these groups.
// What is in sessions/ and private/ stays its owner's. Root's to do; a writer who changes names in
// it meanwhile gets nothing else by it. The folder, as settings name it. Errors: NOT_ROOT,
// NO_GROUP, NOT_A_STORAGE (relative, a folder of the system or of everybody, or one that holds
// anything else), CANNOT_REACH (below a folder that others may not pass), CANNOT_WRITE.
Result<std::filesystem::path> shareStorage(const std::filesystem::path& storage,
                                           const StorageGroups& groups = {});

}  // namespace trephine
