#include "base/shared_folder.h"

#include <sys/stat.h>

#include <system_error>

namespace trephine {

namespace {

namespace fs = std::filesystem;

bool has(const fs::path& folder, mode_t bits) {
  struct stat at {};
  return ::stat(folder.empty() ? "." : folder.c_str(), &at) == 0 && S_ISDIR(at.st_mode) &&
         (at.st_mode & bits) == bits;
}

void openToGroup(const fs::path& path, mode_t folder) {
  struct stat at {};
  if (::lstat(path.c_str(), &at) != 0 || S_ISLNK(at.st_mode)) return;
  (void)::chmod(path.c_str(), modeInGroups(at.st_mode, folder));
}

}  // namespace

bool isGroups(const fs::path& folder) {
  return has(folder, S_ISGID | S_IWGRP) && !has(folder, S_ISVTX);
}

bool isEachOnesOwn(const fs::path& folder) {
  return has(folder, S_ISGID | S_ISVTX | S_IWGRP);
}

mode_t modeInGroups(mode_t own, mode_t folder) {
  const mode_t owners = own & S_IRWXU;
  mode_t mode = owners | owners >> 3 | ((owners >> 6) & folder & (S_IROTH | S_IXOTH));
  if (S_ISDIR(own)) mode |= S_ISGID;
  return mode;
}

void giveToGroup(const fs::path& made) {
  const fs::path folder = made.parent_path();
  struct stat at {};
  std::error_code ec;
  if (!isGroups(folder) || fs::is_symlink(made, ec) ||
      ::stat(folder.empty() ? "." : folder.c_str(), &at) != 0) {
    return;
  }
  openToGroup(made, at.st_mode);
  auto it = fs::recursive_directory_iterator(made, ec);
  for (; !ec && it != fs::end(it); it.increment(ec)) openToGroup(it->path(), at.st_mode);
}

void keepOwn(const fs::path& made) {
  if (!isEachOnesOwn(made.parent_path())) return;
  (void)::chmod(made.c_str(), S_IRUSR | S_IWUSR | S_IRGRP);
}

}  // namespace trephine
