// What the system's loader does not ask of a library before it maps it into memory.
#pragma once

#include <filesystem>

#include "base/result.h"

namespace trephine {

// A library cut short (an interrupted copy) ends the program with a signal as soon as the loader
// touches what is missing, and a pipe keeps it waiting. Error: NO_PLUGIN.
Status checkLibraryFile(const std::filesystem::path& file);

}  // namespace trephine
