// Whether a disk has room, asked before much is written to it.
#pragma once

#include <filesystem>
#include <string>

#include "base/result.h"

namespace trephine {

// Whether `bytes` fit on the disk of this folder, or of the nearest of its parents that is there.
// A disk that does not tell has room. `what` is to be written, in words: "the case". Error:
// CANNOT_WRITE, of the folder. Any thread.
Status enoughRoom(const std::filesystem::path& folder, double bytes, const std::string& what);

}  // namespace trephine
