// How fast could a folder be read at all? Every byte of every file, by one thread.
#pragma once

#include <filesystem>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"

namespace trephine {

struct ReadFloor {
  int files = 0;
  std::uint64_t bytes = 0;
  // Each file opened, asked for its length, read whole, closed: as a copy does it, into one buffer
  // for all files ...
  double seconds = 0.0;
  // ... and into fresh memory for all of them, which costs a page fault for every 4 KB besides.
  double kept_seconds = 0.0;
};

// Files directly in `folder`, by name. Errors: MISSING_FOLDER, UNREADABLE, CANCELLED.
Result<ReadFloor> readEveryByte(const std::filesystem::path& folder,
                                const Progress& progress = Progress());
Json toJson(const ReadFloor& floor);  // {files, bytes, seconds, kept_seconds}

}  // namespace trephine
