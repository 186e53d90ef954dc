#include "base/locked_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <system_error>
#include <vector>

#include "base/file.h"

namespace trephine {

namespace fs = std::filesystem;

namespace {

constexpr const char* kRandom = "XXXXXX";  // mkdtemp's

Descriptor opened(const fs::path& folder) {
  return Descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
}

// One of this account, of a program that has ended; it is locked meanwhile, so that none begins to
// write there.
void removeIfLeft(const fs::path& folder) {
  constexpr auto kOld = std::chrono::hours(24);
  const Descriptor lock = opened(folder);
  struct stat status {};
  if (!lock.ok() || ::fstat(lock.get(), &status) != 0 || status.st_uid != ::geteuid()) return;
  bool left = ::flock(lock.get(), LOCK_EX | LOCK_NB) == 0;
  std::error_code ec;
  if (!left && errno != EWOULDBLOCK) {
    const auto last = fs::last_write_time(folder, ec);
    left = !ec && fs::file_time_type::clock::now() - last > kOld;
  }
  if (left) fs::remove_all(folder, ec);
}

}  // namespace

Result<LockedFolder> LockedFolder::make(const fs::path& parent, const std::string& name,
                                        const fs::path& wanted) {
  const std::string pattern = (parent / (name + kRandom)).string();
  constexpr int kMostTries = 10;
  for (int tries = 1;; ++tries) {
    std::string path = pattern;
    if (!::mkdtemp(path.data())) return writeError(wanted, errno);
    Descriptor lock = opened(path);
    const int why = errno;
    while (lock.ok() && ::flock(lock.get(), LOCK_EX) != 0 && errno == EINTR) {  // where it is known
    }
    std::error_code ec;
    if (lock.ok() && fs::is_directory(path, ec)) return LockedFolder(path, std::move(lock));
    // Another program may have taken it for one that was left, before it was locked.
    fs::remove(path, ec);
    if (why != ENOENT || tries == kMostTries) return writeError(wanted, why);
  }
}

void LockedFolder::removeLeft(const fs::path& parent, const std::string& mark) {
  const std::size_t random = std::string(kRandom).size();
  std::vector<fs::path> found;
  std::error_code ec;
  for (auto it = fs::directory_iterator(parent, ec); !ec && it != fs::end(it); it.increment(ec)) {
    const std::string name = it->path().filename().string();
    std::error_code none;
    const std::size_t at = name.rfind(mark);
    if (at == std::string::npos || name.size() != at + mark.size() + random) continue;
    if (it->symlink_status(none).type() == fs::file_type::directory) found.push_back(it->path());
  }
  for (const fs::path& folder : found) removeIfLeft(folder);
}

LockedFolder::~LockedFolder() {
  std::error_code ec;
  if (!path_.empty()) fs::remove_all(path_, ec);
}

}  // namespace trephine
