#include "library/shared_storage.h"

#include <dirent.h>
#include <fcntl.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <memory>
#include <string>

#include "base/descriptor.h"
#include "base/file.h"
#include "base/shared_folder.h"
#include "base/tr.h"
#include "base/utf8.h"
#include "library/case_folders.h"
#include "library/codes.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

// What Trephine keeps in a storage folder: nothing else is in one.
enum class Holds {
  entries,          // a folder for each
  files,            // files and folders
  parts,            // folders of files, of which kPrivatePart stays its owner's
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
                                         {".parts", Holds::parts, 02775},
                                         {"private", Holds::of_their_owners, 03770},
                                         {"sessions", Holds::of_their_owners, 03777},
                                         {".lock", Holds::nothing, 0660}};

Result<gid_t> groupOf(const std::string& name) {
  const group* found = ::getgrnam(name.c_str());
  if (found) return found->gr_gid;
  return Error{code::kNoGroup, tr("There is no such group on this machine"), name,
               tr("Install Trephine's package, or make it: addgroup --system {}", name)};
}

// "/srv/a/../trephine/" is /srv/trephine.
fs::path withoutDots(const fs::path& given) {
  const fs::path normal = given.lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

Error notAStorage(const std::string& what, const fs::path& where) {
  return {code::kNotAStorage, what, where.string(),
          tr("Name a folder of its own, such as /srv/trephine; it is made where it is missing")};
}

// Where it lies: in no folder of the system, and where no link leads.
Status checkPlace(const fs::path& storage) {
  if (!storage.is_absolute()) {
    return notAStorage(tr("The folder must be given from the root on"), storage);
  }
  if (storage.string() != cleanUtf8(storage.string())) {
    return notAStorage(tr("The name of this folder holds what settings cannot name"), storage);
  }
  std::error_code ec;
  // Where a link lies on the way another folder would be shared than the one that was checked.
  const fs::path reached = fs::weakly_canonical(storage, ec);
  if (ec) return notAStorage(tr("This folder cannot be reached: {}", ec.message()), storage);
  if (reached != storage)
    return notAStorage(tr("There is a link on the way to this folder"), storage);
  constexpr const char* kSystem[] = {"bin", "boot", "dev", "etc",  "lib", "lib32", "lib64",
                                     "opt", "proc", "run", "sbin", "sys", "usr",   "root"};
  const auto top = std::next(storage.begin());
  const int least = *top == "var" ? 4 : 3;  // names, with the root's
  if (std::distance(storage.begin(), storage.end()) < least ||
      std::ranges::find(kSystem, top->string()) != std::end(kSystem)) {
    return notAStorage(tr("This folder is the system's"), storage);
  }
  return {};
}

// A file of two names is perhaps another's, and a link leads elsewhere.
Status checkEntry(const struct stat& at, const fs::path& path) {
  if (!S_ISDIR(at.st_mode) && !S_ISREG(at.st_mode)) {
    return notAStorage(tr("This is neither a file nor a folder"), path);
  }
  if (S_ISREG(at.st_mode) && at.st_nlink > 1) {
    return notAStorage(tr("This file has another name elsewhere"), path);
  }
  return {};
}

Status checkEntry(const fs::path& path) {
  struct stat at {};
  if (::lstat(path.c_str(), &at) != 0) return {};  // gone meanwhile
  return checkEntry(at, path);
}

Status checkInside(const fs::path& folder, Holds holds) {
  std::error_code ec;
  auto inside = fs::recursive_directory_iterator(folder, ec);
  for (; !ec && inside != fs::end(inside); inside.increment(ec)) {
    std::error_code unknown;
    if (holds == Holds::entries && inside.depth() == 0 &&
        inside->symlink_status(unknown).type() != fs::file_type::directory) {
      return notAStorage(tr("This is none of Trephine's files"), inside->path());
    }
    if (Status good = checkEntry(inside->path()); !good) return good;
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
      return notAStorage(tr("There is something else in this folder"), at->path());
    }
    const bool file = part->holds == Holds::nothing;
    std::error_code unknown;
    if (at->symlink_status(unknown).type() !=
        (file ? fs::file_type::regular : fs::file_type::directory)) {
      return notAStorage(tr("This is none of Trephine's files"), at->path());
    }
    any = true;
    if (part->holds == Holds::of_their_owners) continue;
    if (Status good = file ? checkEntry(at->path()) : checkInside(at->path(), part->holds); !good)
      return good;
  }
  struct stat own {};
  if (::stat(storage.c_str(), &own) != 0) return {};
  if (!any && own.st_gid != 0) {
    return notAStorage(tr("This folder is empty, and of a group of the system"), storage);
  }
  if (own.st_mode & (S_IWOTH | S_ISVTX)) {
    return notAStorage(tr("All accounts of this machine may write into this folder"), storage);
  }
  return {};
}

// Who may not pass a folder on the way reaches none of it.
Status checkWay(const fs::path& storage) {
  for (fs::path on = storage.parent_path();; on = on.parent_path()) {
    struct stat at {};
    const bool there = ::stat(on.c_str(), &at) == 0;
    if (there && !S_ISDIR(at.st_mode)) return notAStorage(tr("This is a file, not a folder"), on);
    if (there && (at.st_mode & S_IXOTH) == 0) {
      return Error{code::kCannotReach, tr("Other accounts may not pass this folder on the way"),
                   on.string(), tr("Let them pass it (chmod o+x), or name another")};
    }
    if (on == on.parent_path()) return {};
  }
}

// ---- From here on by descriptors: whatever a writer puts in the place of a name meanwhile, what
// is given away is what was looked at.

Descriptor openIn(int folder, const char* name, int how) {
  return Descriptor(::openat(folder, name, how | O_NOFOLLOW | O_CLOEXEC, 0600));
}

Status give(int fd, gid_t group, mode_t mode, const fs::path& path) {
  if (::fchown(fd, 0, group) != 0 || ::fchmod(fd, mode) != 0) return writeError(path, errno);
  return {};
}

// What is in it already is root's, and the group's to change: who made it has no right of his own.
// `depth`: of the folder, below the part.
Status giveInside(int folder, const StoragePart& part, gid_t group, const fs::path& path,
                  int depth = 0) {
  DIR* listed = ::fdopendir(::dup(folder));
  if (!listed) return writeError(path, errno);
  const std::unique_ptr<DIR, int (*)(DIR*)> closed(listed, &::closedir);
  for (const dirent* entry; (entry = ::readdir(listed));) {
    const std::string name = entry->d_name;
    if (name == "." || name == "..") continue;
    const fs::path at_path = path / name;
    const Descriptor one = openIn(folder, name.c_str(), O_RDONLY | O_NONBLOCK);
    struct stat at {};
    if (!one.ok() && errno == ENOENT) continue;
    if (!one.ok() && (errno == ELOOP || errno == ENXIO)) {
      return notAStorage(tr("This is neither a file nor a folder"), at_path);
    }
    if (!one.ok() || ::fstat(one.get(), &at) != 0) return writeError(at_path, errno);
    if (Status good = checkEntry(at, at_path); !good) return good;
    if (part.holds == Holds::parts && depth == 1 && S_ISREG(at.st_mode) &&
        name == case_folders::kPrivatePart) {
      continue;
    }
    if (Status given = give(one.get(), group, modeInGroups(at.st_mode, part.mode), at_path);
        !given) {
      return given;
    }
    if (!S_ISDIR(at.st_mode)) continue;
    if (Status given = giveInside(one.get(), part, group, at_path, depth + 1); !given) return given;
  }
  return {};
}

Status givePart(int storage, const StoragePart& part, gid_t group, const fs::path& path) {
  const bool file = part.holds == Holds::nothing;
  if (!file && ::mkdirat(storage, part.name, 0700) != 0 && errno != EEXIST) {
    return writeError(path, errno);
  }
  const Descriptor one =
      openIn(storage, part.name, file ? O_RDWR | O_CREAT | O_NONBLOCK : O_DIRECTORY);
  struct stat at {};
  if (!one.ok() || ::fstat(one.get(), &at) != 0) return writeError(path, errno);
  if (Status good = checkEntry(at, path); !good) return good;
  if (Status given = give(one.get(), group, part.mode, path); !given) return given;
  if (file || part.holds == Holds::of_their_owners) return {};
  return giveInside(one.get(), part, group, path);
}

}  // namespace

Result<fs::path> shareStorage(const fs::path& given, const StorageGroups& groups) {
  if (::geteuid() != 0) {
    return Error{code::kNotRoot, tr("Only an administrator can give a folder to groups"),
                 given.string(), tr("Run it with sudo")};
  }
  const fs::path storage = withoutDots(given);
  for (const auto check : {checkPlace, checkContents, checkWay}) {
    if (Status good = check(storage); !good) return good.error();
  }
  const Result<gid_t> readers = groupOf(groups.readers), writers = groupOf(groups.writers);
  if (!readers) return readers.error();
  if (!writers) return writers.error();
  if (Status made = makeFolder(storage); !made) return made.error();
  const Descriptor folder = openIn(AT_FDCWD, storage.c_str(), O_DIRECTORY);
  if (!folder.ok()) return writeError(storage, errno);
  std::error_code ec;
  if (fs::read_symlink("/proc/self/fd/" + std::to_string(folder.get()), ec) != storage) {
    return notAStorage(tr("There is a link on the way to this folder"), storage);
  }
  constexpr mode_t kLook = 0750;
  if (Status done = give(folder.get(), *readers, kLook, storage); !done) return done.error();
  for (const StoragePart& part : kStorageParts) {
    if (Status done = givePart(folder.get(), part, *writers, storage / part.name); !done)
      return done.error();
  }
  // Folders on the way that were made now are as the umask has it.
  if (Status passed = checkWay(storage); !passed) return passed.error();
  return storage;
}

}  // namespace trephine
