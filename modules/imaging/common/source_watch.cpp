#include "imaging/common/detail/source_watch.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "base/descriptor.h"

namespace trephine {

namespace {

constexpr std::size_t kFewest = 3;

// Of a path or device that is not there, rather than of a right or a limit that is lacking.
bool meansGone(int error) {
  constexpr std::array kErrors{ENOENT,   ENOTDIR,   ENODEV,       ENXIO,     EIO,       ESTALE,
                               ENOTCONN, EHOSTDOWN, EHOSTUNREACH, ETIMEDOUT, ENOMEDIUM, EREMOTEIO};
  return std::ranges::find(kErrors, error) != kErrors.end();
}

}  // namespace

bool isGone(const std::filesystem::path& file, std::uint64_t bytes) {
  const Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (!opened.ok()) return meansGone(errno);
  ::posix_fadvise(opened.get(), 0, 0, POSIX_FADV_DONTNEED);
  char last;
  const auto read = ::pread(opened.get(), &last, 1, off_t(std::max<std::uint64_t>(bytes, 1) - 1));
  return read < 0 && meansGone(errno);
}

void SourceWatch::end(std::size_t number, const std::filesystem::path& file, std::uint64_t bytes,
                      bool whole) {
  const bool gone = !whole && isGone(file, bytes);
  const std::lock_guard lock(mutex_);
  if (gone) {
    gone_.push_back(number);
  } else if (!last_number_ || number > *last_number_) {
    last_number_ = number;
    last_good_ = file;
    last_bytes_ = bytes;
  }
}

bool SourceWatch::vanished() const {
  const std::lock_guard lock(mutex_);
  if (gone_.empty()) return false;
  if (!last_number_ || isGone(last_good_, last_bytes_)) return true;
  const auto since = std::size_t(
      std::ranges::count_if(gone_, [&](std::size_t number) { return number > *last_number_; }));
  return since >= kFewest && 10 * since >= began_.load();
}

}  // namespace trephine
