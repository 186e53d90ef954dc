// Tells a source that went away while it was read (a stick pulled out, a share lost) from a file or
// two that cannot be read.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <vector>

namespace trephine {

// Whether a file of so many bytes is not there any more, or the device that it lies on fails. Looks
// past what the system holds of it in memory. False for what merely may not be read.
bool isGone(const std::filesystem::path& file, std::uint64_t bytes);

// Told of every file that is read, by any thread.
class SourceWatch {
 public:
  // Before a file is read: its number in line.
  std::size_t begin() { return began_.fetch_add(1); }
  // After that. `whole`: it was read without a fault; else whether it is gone is looked up.
  void end(std::size_t number, const std::filesystem::path& file, std::uint64_t bytes, bool whole);
  // At the end, or whenever it is asked: files are gone, and with them what could be read before,
  // or everything that came after (three files and a tenth of all at least).
  bool vanished() const;

 private:
  std::atomic<std::size_t> began_{0};
  mutable std::mutex mutex_;
  std::filesystem::path last_good_;
  std::uint64_t last_bytes_ = 0;
  std::optional<std::size_t> last_number_;  // of that file
  std::vector<std::size_t> gone_;           // numbers
};

}  // namespace trephine
