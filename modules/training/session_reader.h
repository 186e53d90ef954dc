// Reads a recording, also one that was cut short or is still being written.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "base/result.h"
#include "haptics/haptic_types.h"
#include "training/recording.h"

namespace trephine {

// Whether a program writes a recording now: it is marked so, which one whose program was killed
// stays, and it was written a moment ago. Any regular file.
bool isBeingWritten(const std::filesystem::path& recording);

class SessionReader {
 public:
  // Errors: MISSING_FILE, CANNOT_READ (not by this account), BAD_RECORDING (not a recording, or
  // damaged), NEWER_VERSION, OLDER_VERSION.
  static Result<std::unique_ptr<SessionReader>> open(const std::filesystem::path& file);
  ~SessionReader();
  SessionReader(const SessionReader&) = delete;
  SessionReader& operator=(const SessionReader&) = delete;

  const RecordingHeader& header() const;
  std::size_t armCount() const;
  // Ticks that are complete for all arms.
  std::uint64_t tickCount() const;
  // Nothing when the recording was cut short.
  const std::optional<RecordingEnd>& end() const;

  // Ticks [first, first + count). Errors: BAD_RECORDING, with the first tick that cannot be read.
  Result<std::vector<TickRecord>> ticks(std::uint64_t first, std::uint64_t count) const;
  // The tables of tissues that they point to stay as long as the reader does.
  Result<std::vector<Event>> events() const;
  Result<std::vector<CarveRecord>> carves() const;

 private:
  SessionReader();
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace trephine
