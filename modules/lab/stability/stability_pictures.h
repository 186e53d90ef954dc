// Stability maps as pictures: markers over sampling period and tissue, the published limits over
// them.
#pragma once

#include <filesystem>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "lab/stability/stability_maps.h"
#include "plot/plot.h"

namespace trephine {

// 1200x900; periods in ms.
plot::Plot plotOf(const StabilityMap& map);

// Writes each map as FOLDER/<file_name> and returns their paths. A file is whole or not touched;
// maps written before an error stay. Errors: BAD_ARGUMENT, CANNOT_DRAW, CANNOT_WRITE, WRITE_FAILED,
// CANCELLED.
Result<std::vector<std::filesystem::path>> writeStabilityMaps(const std::vector<MapCell>& cells,
                                                              const std::filesystem::path& folder,
                                                              const Progress& progress);

}  // namespace trephine
