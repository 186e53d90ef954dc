#include "base/sync_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "base/descriptor.h"
#include "base/file.h"

namespace trephine {

namespace fs = std::filesystem;

Status syncFolder(const fs::path& folder) {
  const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!opened.ok()) return writeError(folder, errno);
  const int failed = ::fsync(opened.get()) == 0 ? 0 : errno;
  // Some file systems know no such call on a folder.
  if (failed != 0 && failed != EINVAL && failed != ENOTSUP) return writeError(folder, failed);
  return {};
}

}  // namespace trephine
