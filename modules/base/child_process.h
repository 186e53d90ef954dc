// A program run as a child process: how long it took and what memory it had.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"

namespace trephine {

struct ChildCommand {
  std::vector<std::string> words;  // the program's path, then its arguments
  std::filesystem::path output;    // a file that gets its stdout; stderr is dropped
  std::filesystem::path home;      // its HOME, so that it leaves nothing in the user's; empty: ours
  double limit_s = 120.0;          // after which it is ended
  std::string step{};              // reported meanwhile, as the limit comes nearer; empty: nothing
  // To have its `peak_rss_mb`. Each page that this program writes until the child's exec costs a
  // page fault then: not beside a haptic thread.
  bool measures_memory = false;
};

struct ChildRun {
  int exit_code = 0;       // 128 + the signal's number where one ended it
  bool timed_out = false;  // then it was ended
  double seconds = 0.0;    // wall time from just before exec to its end
  // Resident memory at its peak, MB of 2^20 bytes, where it was asked for; at least what this
  // program held when the child was started, which Linux counts for both.
  std::optional<double> peak_rss_mb;
};

// Waits for the child's end; it ends with this process too. One that is to end gets a SIGTERM, and
// 1.5 s later a SIGKILL. Errors: CANCELLED (the child was ended), CANNOT_RUN (says what the system
// refused).
Result<ChildRun> runChild(const ChildCommand& command, const Progress& progress);

// The error that a command of ours with --json left in its `output`; nothing where it holds
// something else.
std::optional<Error> errorSaid(const std::filesystem::path& output);

}  // namespace trephine
