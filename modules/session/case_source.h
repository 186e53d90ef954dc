// Where a case comes from: a built-in phantom, a folder of CT, or a volume file.
#pragma once

#include <memory>
#include <string>

#include "base/progress.h"
#include "base/result.h"
#include "volume/volume.h"

namespace trephine {

// `source` is "phantom:cranium", "phantom:abdomen", a DICOM folder or file, or a volume file
// (volume/volume_files.h); from a folder the best CT series is taken. Errors are those of the
// importer and the readers, and NO_CASE for an empty source. Any thread; reports progress and can be
// cancelled.
Result<Volume> openCase(const std::string& source, const Progress& progress = Progress());

bool isPhantom(const std::string& source);

}  // namespace trephine
