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

// As its owner may read and write it, so may its group.
void openToGroup(const fs::path& path) {
  struct stat at {};
  if (::lstat(path.c_str(), &at) != 0 || S_ISLNK(at.st_mode)) return;
  mode_t mode = at.st_mode & 07777;
  mode |= (mode & S_IRWXU) >> 3;
  if (S_ISDIR(at.st_mode)) mode |= S_ISGID;
  (void)::chmod(path.c_str(), mode);
}

}  // namespace

bool isGroups(const fs::path& folder) {
  return has(folder, S_ISGID | S_IWGRP) && !has(folder, S_ISVTX);
}

bool isEachOnesOwn(const fs::path& folder) {
  return has(folder, S_ISGID | S_ISVTX | S_IWGRP);
}

void giveToGroup(const fs::path& made) {
  if (!isGroups(made.parent_path())) return;
  openToGroup(made);
  std::error_code ec;
  auto it = fs::recursive_directory_iterator(made, ec);
  for (; !ec && it != fs::end(it); it.increment(ec)) openToGroup(it->path());
}

void keepOwn(const fs::path& made) {
  if (!isEachOnesOwn(made.parent_path())) return;
  (void)::chmod(made.c_str(), S_IRUSR | S_IWUSR | S_IRGRP);
}

}  // namespace trephine
