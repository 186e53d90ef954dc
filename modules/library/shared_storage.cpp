#include "library/shared_storage.h"

#include <fcntl.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <optional>
#include <string>

#include "base/file.h"
#include "base/shared_folder.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

// What Trephine keeps in a storage folder: nothing else is in one.
enum class Holds {
  entries,          // a folder for each
  files,            // files and folders
  of_their_owners,  // what stays theirs
  nothing           // it is a file
};
struct StoragePart {
  const char* name;
  Holds holds;
  mode_t mode;
};
constexpr StoragePart kStorageParts[] = {{"cases", Holds::entries, 02775},
                                         {"exercises", Holds::entries, 02775},
                                         {"tissues", Holds::files, 02775},
                                         {".parts", Holds::files, 02775},
                                         {"private", Holds::of_their_owners, 03770},
                                         {"sessions", Holds::of_their_owners, 03777},
                                         {".lock", Holds::nothing, 0664}};

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

Status giveFile(const fs::path& path, gid_t group, mode_t mode) {
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, mode);
  if (fd < 0) return writeError(path, errno);
  ::close(fd);
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

Error notAStorage(const std::string& what, const fs::path& where) {
  return {"NOT_A_STORAGE", what, where.string(),
          "Name a folder of its own, such as /srv/trephine; it is made where it is missing"};
}

// Where it lies: in no folder of the system, and where no link leads.
Status checkPlace(const fs::path& storage) {
  if (!storage.is_absolute()) {
    return notAStorage("The folder must be given from the root on", storage);
  }
  std::error_code ec;
  // Where a link lies on the way another folder would be shared than the one that was checked.
  if (fs::weakly_canonical(storage, ec) != storage || ec) {
    return notAStorage("There is a link on the way to this folder", storage);
  }
  constexpr const char* kSystem[] = {"bin", "boot", "dev", "etc",  "lib", "lib32", "lib64",
                                     "opt", "proc", "run", "sbin", "sys", "usr",   "root"};
  const auto top = std::next(storage.begin());
  if (std::distance(storage.begin(), storage.end()) < 3 ||
      std::ranges::find(kSystem, top->string()) != std::end(kSystem)) {
    return notAStorage("This folder is the system's", storage);
  }
  return {};
}

// A file of two names is perhaps another's.
Status checkNames(const fs::directory_entry& entry) {
  std::error_code ec;
  if (entry.symlink_status(ec).type() == fs::file_type::regular && entry.hard_link_count(ec) > 1) {
    return notAStorage("This file has another name elsewhere", entry.path());
  }
  return {};
}

Status checkInside(const fs::path& folder, Holds holds) {
  std::error_code ec;
  auto inside = fs::recursive_directory_iterator(folder, ec);
  for (; !ec && inside != fs::end(inside); inside.increment(ec)) {
    std::error_code unknown;
    if (holds == Holds::entries && inside.depth() == 0 &&
        inside->symlink_status(unknown).type() != fs::file_type::directory) {
      return notAStorage("This is none of Trephine's files", inside->path());
    }
    if (Status good = checkNames(*inside); !good) return good;
  }
  return {};
}

// Nothing but what Trephine keeps there, so that no other folder is taken for a storage.
Status checkContents(const fs::path& storage) {
  bool any = false;
  std::error_code ec;
  for (fs::directory_iterator at(storage, ec), end; !ec && at != end; at.increment(ec)) {
    const auto part = std::ranges::find(kStorageParts, at->path().filename(),
                                        [](const StoragePart& p) { return fs::path(p.name); });
    if (part == std::end(kStorageParts)) {
      return notAStorage("There is something else in this folder", at->path());
    }
    const bool file = part->holds == Holds::nothing;
    std::error_code unknown;
    if (at->symlink_status(unknown).type() !=
        (file ? fs::file_type::regular : fs::file_type::directory)) {
      return notAStorage("This is none of Trephine's files", at->path());
    }
    any = true;
    if (part->holds == Holds::of_their_owners) continue;
    if (Status good = file ? checkNames(*at) : checkInside(at->path(), part->holds); !good)
      return good;
  }
  struct stat own {};
  if (!any && ::stat(storage.c_str(), &own) == 0 && own.st_gid != 0) {
    return notAStorage("This folder is empty, and of a group of the system", storage);
  }
  return {};
}

// Who may not pass a folder on the way reaches none of it.
Status checkWay(const fs::path& storage) {
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
  for (const auto check : {checkPlace, checkContents, checkWay}) {
    if (Status good = check(storage); !good) return good;
  }
  const Result<gid_t> readers = groupOf(groups.readers), writers = groupOf(groups.writers);
  if (!readers) return readers.error();
  if (!writers) return writers.error();
  constexpr mode_t kLook = 0750;
  if (Status done = giveFolder(storage, *readers, kLook); !done) return done;
  for (const StoragePart& part : kStorageParts) {
    const fs::path path = storage / part.name;
    const bool file = part.holds == Holds::nothing;
    Status done =
        file ? giveFile(path, *writers, part.mode) : giveFolder(path, *writers, part.mode);
    if (done && !file && part.holds != Holds::of_their_owners) done = giveInside(path, *writers);
    if (!done) return done;
  }
  return {};
}

}  // namespace trephine
