#include "lab/import/read_floor.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "base/codes.h"
#include "base/descriptor.h"
#include "volume/codes.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

// Reads a whole file to `to`, which has room for `room` bytes; its length, or nothing.
std::optional<std::size_t> readWhole(const fs::path& file, char* to, std::size_t room) {
  const Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (!opened.ok()) return std::nullopt;
  struct stat status {};
  bool good = ::fstat(opened.get(), &status) == 0 && std::size_t(status.st_size) <= room;
  std::size_t done = 0;
  while (good && done < std::size_t(status.st_size)) {
    const ssize_t got = ::read(opened.get(), to + done, std::size_t(status.st_size) - done);
    good = got > 0;
    if (good) done += std::size_t(got);
  }
  if (!good) return std::nullopt;
  return done;
}

}  // namespace

Result<ReadFloor> readEveryByte(const fs::path& folder, const Progress& progress) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    files.push_back(it->path());
  }
  if (error) return Error{code::kMissingFolder, "The folder cannot be read", folder.string(), ""};
  std::sort(files.begin(), files.end());

  ReadFloor floor;
  floor.files = int(files.size());
  std::size_t longest = 0;
  for (const fs::path& file : files) {
    const auto bytes = fs::file_size(file, error);
    if (error) return Error{code::kUnreadable, "A file has no length", folder.string(), ""};
    longest = std::max<std::size_t>(longest, bytes);
    floor.bytes += bytes;
  }
  for (const bool keep : {false, true}) {
    const auto start = std::chrono::steady_clock::now();
    const std::size_t room = keep ? floor.bytes : longest;
    const std::unique_ptr<char[]> buffer(new char[std::max<std::size_t>(room, 1)]);
    std::size_t at = 0;
    for (const fs::path& file : files) {
      if (progress.cancelled()) return Error{code::kCancelled, "The reading was cancelled", "", ""};
      const auto got = readWhole(file, &buffer[at], room - at);
      if (!got) return Error{code::kUnreadable, "A file cannot be read", folder.string(), ""};
      if (keep) at += *got;
    }
    (keep ? floor.kept_seconds : floor.seconds) =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return floor;
}

Json toJson(const ReadFloor& floor) {
  return {{"files", floor.files},
          {"bytes", floor.bytes},
          {"seconds", floor.seconds},
          {"kept_seconds", floor.kept_seconds}};
}

}  // namespace trephine
