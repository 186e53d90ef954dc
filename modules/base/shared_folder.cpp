#include "base/shared_folder.h"

#include <sys/stat.h>

#include <system_error>

namespace trephine {

namespace {

namespace fs = std::filesystem;

// Of a folder; 0 of what is none.
mode_t modeOf(const fs::path& folder) {
  struct stat at {};
  const bool there = ::stat(folder.empty() ? "." : folder.c_str(), &at) == 0;
  return there && S_ISDIR(at.st_mode) ? at.st_mode : 0;
}

bool has(mode_t mode, mode_t bits) {
  return (mode & bits) == bits;
}

bool isGroups(mode_t folder) {
  return has(folder, S_ISGID | S_IWGRP) && !has(folder, S_ISVTX);
}

void openToGroup(const fs::path& path, mode_t folder) {
  struct stat at {};
  if (::lstat(path.c_str(), &at) != 0 || S_ISLNK(at.st_mode)) return;
  (void)::chmod(path.c_str(), modeInGroups(at.st_mode, folder));
}

}  // namespace

bool isGroups(const fs::path& folder) {
  return isGroups(modeOf(folder));
}

bool isEachOnesOwn(const fs::path& folder) {
  return has(modeOf(folder), S_ISGID | S_ISVTX | S_IWGRP);
}

mode_t modeInGroups(mode_t own, mode_t folder) {
  const mode_t owners = own & S_IRWXU;
  mode_t mode = owners | owners >> 3 | ((owners >> 6) & folder & (S_IROTH | S_IXOTH));
  if (S_ISDIR(own)) mode |= S_ISGID;
  return mode;
}

void giveToGroup(const fs::path& made) {
  const mode_t folder = modeOf(made.parent_path());
  std::error_code ec;
  if (!isGroups(folder) || fs::is_symlink(made, ec)) return;
  openToGroup(made, folder);
  auto it = fs::recursive_directory_iterator(made, ec);
  for (; !ec && it != fs::end(it); it.increment(ec)) openToGroup(it->path(), folder);
}

void keepOwn(const fs::path& made) {
  if (!isEachOnesOwn(made.parent_path())) return;
  (void)::chmod(made.c_str(), S_IRUSR | S_IWUSR | S_IRGRP);
}

}  // namespace trephine
