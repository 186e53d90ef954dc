// The disk below a folder.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "base/progress.h"
#include "machine/commission/commission_limits.h"

namespace trephine {

// `disk_room` and `disk_write`: so many bytes are written and held to be on the disk, for no longer
// than `most_s`, and are gone again whatever happens. A folder that is not there yet stands for the
// one that it would be made in, unless it has to be there (MISSING_FOLDER).
std::vector<CommissionCheck> checkDisk(const std::filesystem::path& folder, std::size_t bytes,
                                       double most_s, const Progress& progress,
                                       bool has_to_be_there = false);

}  // namespace trephine
