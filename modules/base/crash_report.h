// What is left of a program that crashes: a short report in words that a person may hand on, and
// the name of the recording that it leaves. Nothing is sent anywhere. A report holds the version,
// the signal, the last lines of the log, and the stack as modules and offsets; no folder, no case.
//
//   FOLDER/running-PID     while an exercise is recorded: where
//   FOLDER/crash-PID.txt   the report, until somebody was told of it; then crash-TIME.txt
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "base/result.h"

namespace trephine {

// From here on; the folder is made this account's alone, unless it is a link. Once, before there
// are threads. Errors: CANNOT_WRITE; then there are no reports.
Status reportCrashesTo(const std::filesystem::path& folder);
// The exercise that is being recorded; empty: none. The thread that asks for it does the writing.
void noteRecording(const std::filesystem::path& recording);
// A line of the log, kept for the report. Any thread.
void keepLastLine(const char* text, std::size_t size);

struct LeftBehind {
  std::filesystem::path report;     // empty: it was killed, or the machine went off
  std::filesystem::path recording;  // as far as it came; empty: none was made
};
// Of the newest program of this account that crashed, or was killed while it recorded, since
// somebody was told last. What is given here is not given again. Reports older than the last ten
// are deleted.
std::optional<LeftBehind> takeLeftBehind(const std::filesystem::path& folder);

}  // namespace trephine
