// The recordings of a folder, as a person chooses among them.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "base/system.h"

namespace trephine {

struct ListedRecording {
  std::filesystem::path file;
  std::filesystem::file_time_type written;
  std::string exercise;       // the exercise's name
  std::string case_source;    // of a built-in case; else empty
  std::string volume_sha256;  // of the case
  double seconds = 0.0;       // without its pauses
  bool cut_short = false;
  std::optional<Error> problem;  // why it cannot be replayed; of the rest only `file` holds
  // Which case it was done on.
  const std::string& caseKey() const { return case_source.empty() ? volume_sha256 : case_source; }
};

// Any file; what is none says so in `problem`. Read in this process, which a damaged file may keep
// waiting or end: what strangers may have put there is listed by the functions below.
ListedRecording listRecording(const std::filesystem::path& file);
Json toJson(const ListedRecording& row);  // a line of `trephine-lab recordings --json`

// How files that may be anybody's are read: each is opened by a child process, `trephine-lab
// recordings`. A file that takes longer than `patience_s`, or that ends the child, is a row with
// its problem (TAKES_TOO_LONG, BAD_RECORDING, UNREADABLE), and the rest goes on; after each that
// takes too long with half the patience.
struct ReadApart {
  std::filesystem::path program = labProgram();
  double patience_s = 10.0;
  // Told what has been read so far, on the thread of the call: after a child, and a tenth of a
  // second after the last time. A list need not wait for its slowest file. May be empty.
  std::function<void(const std::vector<ListedRecording>& so_far)> read{};
};
// One row for each file, in their order. Any thread; some milliseconds for each file, and 50 ms for
// each child: the first reads 10 files, each next one four times as many, at most 200.
// Errors: CANCELLED, CANNOT_RUN, NO_TEMPORARY_FOLDER.
Result<std::vector<ListedRecording>> listFiles(const std::vector<std::filesystem::path>& files,
                                               const Progress& progress = Progress(),
                                               const ReadApart& how = ReadApart());
// The recordings of a folder, read and listed the newest first, without those that other accounts
// keep for themselves; a folder that is not there has none. As listFiles().
Result<std::vector<ListedRecording>> listRecordings(const std::filesystem::path& folder,
                                                    const Progress& progress = Progress(),
                                                    const ReadApart& how = ReadApart());

}  // namespace trephine
