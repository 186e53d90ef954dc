#include "library/shared_storage.h"

#include <fcntl.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <optional>
#include <set>
#include <string>

#include "base/file.h"
#include "base/shared_folder.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

Result<gid_t> groupOf(const std::string& name) {
  const group* found = ::getgrnam(name.c_str());
  if (found) return found->gr_gid;
  return Error{"NO_GROUP", "There is no such group on this machine", name,
               "Install Trephine's package, or make it: addgroup --system " + name};
}

Status give(const fs::path& path, gid_t group, std::optional<mode_t> mode) {
  if (::lchown(path.c_str(), uid_t(-1), group) != 0) return writeError(path, errno);
  if (mode && ::chmod(path.c_str(), *mode) != 0) return writeError(path, errno);
  return {};
}

Status giveFolder(const fs::path& path, gid_t group, mode_t mode) {
  if (Status made = makeFolder(path); !made) return made;
  std::error_code ec;
  if (fs::is_symlink(path, ec)) {
    return Error{"CANNOT_WRITE", "This is a link to another folder", path.string(),
                 "Name the folder itself"};
  }
  if (::chown(path.c_str(), 0, group) != 0) return writeError(path, errno);
  return give(path, group, mode);
}

// What is in it already.
Status giveInside(const fs::path& folder, gid_t group) {
  std::error_code ec;
  auto it = fs::recursive_directory_iterator(folder, ec);
  for (; !ec && it != fs::end(it); it.increment(ec)) {
    if (Status given = give(it->path(), group, {}); !given) return given;
  }
  for (fs::directory_iterator at(folder, ec), end; !ec && at != end; at.increment(ec)) {
    giveToGroup(at->path());
  }
  return {};
}

// "/srv/a/../trephine/" is /srv/trephine.
fs::path withoutDots(const fs::path& given) {
  const fs::path normal = given.lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

// Nothing but what Trephine keeps in a storage folder, so that no other folder is taken for one.
Status checkIsStorage(const fs::path& storage) {
  const auto refused = [&](const std::string& what, const fs::path& where) {
    return Error{"NOT_A_STORAGE", what, where.string(),
                 "Name a folder of its own, such as /srv/trephine; it is made where it is missing"};
  };
  if (!storage.is_absolute()) return refused("The folder must be given from the root on", storage);
  std::error_code ec;
  // Where a link lies on the way another folder would be shared than the one that was checked.
  if (fs::weakly_canonical(storage, ec) != storage || ec) {
    return refused("There is a link on the way to this folder", storage);
  }
  constexpr const char* kSystem[] = {"bin", "boot", "dev", "etc",  "lib", "lib32", "lib64",
                                     "opt", "proc", "run", "sbin", "sys", "usr",   "root"};
  const auto top = std::next(storage.begin());
  if (std::distance(storage.begin(), storage.end()) < 3 ||
      std::ranges::find(kSystem, top->string()) != std::end(kSystem)) {
    return refused("This folder is the system's", storage);
  }
  const std::set<std::string> ours{"cases",   "exercises", "tissues", ".parts",
                                   "private", "sessions",  ".lock"};
  bool any = false;
  for (fs::directory_iterator at(storage, ec), end; !ec && at != end; at.increment(ec)) {
    const std::string name = at->path().filename().string();
    if (!ours.contains(name)) return refused("There is something else in this folder", at->path());
    const bool file = name == ".lock";
    const auto type = at->symlink_status(ec).type();
    if (type != (file ? fs::file_type::regular : fs::file_type::directory)) {
      return refused("This is none of Trephine's files", at->path());
    }
    any = true;
  }
  ec.clear();
  struct stat own {};
  if (!any && ::stat(storage.c_str(), &own) == 0 && own.st_gid != 0) {
    return refused("This folder is empty, and of a group of the system", storage);
  }
  // A file of two names is perhaps another's.
  for (const char* of : {"cases", "exercises", "tissues", ".parts", ".lock"}) {
    const fs::path at = storage / of;
    if (fs::is_regular_file(at, ec) && fs::hard_link_count(at, ec) > 1) {
      return refused("This file has another name elsewhere", at);
    }
    auto it = fs::recursive_directory_iterator(at, ec);
    for (; !ec && it != fs::end(it); it.increment(ec)) {
      if (it->symlink_status(ec).type() == fs::file_type::regular && it->hard_link_count(ec) > 1) {
        return refused("This file has another name elsewhere", it->path());
      }
    }
    ec.clear();
  }
  for (const char* of : {"cases", "exercises"}) {
    for (fs::directory_iterator at(storage / of, ec), end; !ec && at != end; at.increment(ec)) {
      if (at->symlink_status(ec).type() != fs::file_type::directory) {
        return refused("This is none of Trephine's files", at->path());
      }
    }
    ec.clear();
  }
  // Who may not pass a folder on the way reaches none of it.
  for (fs::path on = storage.parent_path();; on = on.parent_path()) {
    struct stat at {};
    if (::stat(on.c_str(), &at) == 0 && (at.st_mode & S_IXOTH) == 0) {
      return Error{"CANNOT_REACH", "Other accounts may not pass this folder on the way",
                   on.string(), "Let them pass it (chmod o+x), or name another"};
    }
    if (on == on.parent_path()) return {};
  }
}

}  // namespace

Status shareStorage(const fs::path& given, const StorageGroups& groups) {
  if (::geteuid() != 0) {
    return Error{"NOT_ROOT", "Only an administrator can give a folder to groups", given.string(),
                 "Run it with sudo"};
  }
  const fs::path storage = withoutDots(given);
  if (Status good = checkIsStorage(storage); !good) return good;
  const Result<gid_t> readers = groupOf(groups.readers), writers = groupOf(groups.writers);
  if (!readers) return readers.error();
  if (!writers) return writers.error();
  constexpr mode_t kLook = 0750, kGroups = 02775, kOwnOfWriters = 03770, kOwnOfAll = 03777;
  if (Status done = giveFolder(storage, *readers, kLook); !done) return done;
  for (const char* name : {"cases", "exercises", "tissues", ".parts"}) {
    if (Status done = giveFolder(storage / name, *writers, kGroups); !done) return done;
    if (Status done = giveInside(storage / name, *writers); !done) return done;
  }
  if (Status done = giveFolder(storage / "private", *writers, kOwnOfWriters); !done) return done;
  if (Status done = giveFolder(storage / "sessions", *writers, kOwnOfAll); !done) return done;
  const fs::path lock = storage / ".lock";
  const int fd = ::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0664);
  if (fd < 0) return writeError(lock, errno);
  ::close(fd);
  return give(lock, *writers, 0664);
}

}  // namespace trephine
