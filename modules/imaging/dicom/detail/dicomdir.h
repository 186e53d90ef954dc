// A DICOMDIR: which files a medium holds.
#pragma once

#include <filesystem>
#include <vector>

#include "base/progress.h"

namespace trephine {

// Whether the file says that it is a DICOMDIR.
bool isDicomDir(const std::filesystem::path& file);

// The files that a DICOMDIR refers to, found under its own folder whatever the case of their names,
// and never outside of it. Nothing where one of them is not there (a stale DICOMDIR), where none is
// named, or where the file is no DICOMDIR.
std::vector<std::filesystem::path> filesOfDicomDir(const std::filesystem::path& file,
                                                   const Progress& progress = Progress());

}  // namespace trephine
