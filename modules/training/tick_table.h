// A recording as a table for other programs: a line a tick and arm.
#pragma once

#include <filesystem>

#include "base/progress.h"
#include "training/session_reader.h"

namespace trephine {

// The columns: resources/schemas/csv.md. Replaces what is at `file`. Numbers are written so that
// they read back as they were. Errors: those of the recording, CANNOT_WRITE, CANCELLED.
Status writeTickTable(const SessionReader& recording, const std::filesystem::path& file,
                      const Progress& progress = Progress());

}  // namespace trephine
