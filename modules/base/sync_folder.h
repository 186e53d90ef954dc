// A folder's own entries, on the disk.
#pragma once

#include <filesystem>

#include "base/result.h"

namespace trephine {

// Done where the file system knows no such call on a folder. Error: CANNOT_WRITE.
Status syncFolder(const std::filesystem::path& folder);

}  // namespace trephine
