#include "base/sync_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "base/file.h"

namespace trephine {

namespace fs = std::filesystem;

Status syncFolder(const fs::path& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return writeError(folder, errno);
  const int failed = ::fsync(fd) == 0 ? 0 : errno;
  ::close(fd);
  // Some file systems know no such call on a folder.
  if (failed != 0 && failed != EINVAL && failed != ENOTSUP) return writeError(folder, failed);
  return {};
}

}  // namespace trephine
