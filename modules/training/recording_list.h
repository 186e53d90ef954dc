// The recordings of a folder, as a person chooses among them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"

namespace trephine {

struct ListedRecording {
  std::filesystem::path file;
  std::filesystem::file_time_type written;
  std::string exercise;       // the scene's name
  std::string case_source;    // of a built-in case; else empty
  std::string volume_sha256;  // of the case
  double seconds = 0.0;       // without its pauses
  bool cut_short = false;
  std::optional<Error> problem;  // why it cannot be replayed; of the rest only `file` holds
  // Which case it was done on.
  const std::string& caseKey() const { return case_source.empty() ? volume_sha256 : case_source; }
};

// Any file; what is none says so in `problem`.
ListedRecording listRecording(const std::filesystem::path& file);
// The newest first, without those that other accounts keep for themselves; a folder that is not
// there has none. Reads the head of each, which takes some milliseconds. Any thread. Error:
// CANCELLED.
Result<std::vector<ListedRecording>> listRecordings(const std::filesystem::path& folder,
                                                    const Progress& progress = Progress());

}  // namespace trephine
