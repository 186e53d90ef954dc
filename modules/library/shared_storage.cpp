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

// Of a file that is a part of a storage, or of what is in such a folder, at that depth.
Status checkPart(const fs::directory_entry& part, int depth, bool of_folders) {
  std::error_code ec;
  const fs::file_type type = part.symlink_status(ec).type();
  if (of_folders && depth == 0 && type != fs::file_type::directory) {
    return notAStorage("This is none of Trephine's files", part.path());
  }
  // A file of two names is perhaps another's.
  if (type == fs::file_type::regular && part.hard_link_count(ec) > 1) {
    return notAStorage("This file has another name elsewhere", part.path());
  }
  return {};
}

// Nothing but what Trephine keeps in a storage folder, so that no other folder is taken for one.
Status checkContents(const fs::path& storage) {
  struct Part {
    const char* name;
    bool folder = true;
    bool given = true;        // to the groups, with what is in it
    bool of_folders = false;  // which has a folder for each of what it holds
  };
  constexpr Part kParts[] = {
      {"cases", true, true, true}, {"exercises", true, true, true}, {"tissues"},     {".parts"},
      {"private", true, false},    {"sessions", true, false},       {".lock", false}};
  bool any = false;
  std::error_code ec;
  for (fs::directory_iterator at(storage, ec), end; !ec && at != end; at.increment(ec)) {
    const std::string name = at->path().filename().string();
    const auto part =
        std::ranges::find(kParts, name, [](const Part& p) { return std::string(p.name); });
    if (part == std::end(kParts)) {
      return notAStorage("There is something else in this folder", at->path());
    }
    std::error_code unknown;
    const fs::file_type type = at->symlink_status(unknown).type();
    if (type != (part->folder ? fs::file_type::directory : fs::file_type::regular)) {
      return notAStorage("This is none of Trephine's files", at->path());
    }
    any = true;
    if (!part->given) continue;
    if (!part->folder) {
      if (Status good = checkPart(*at, 0, false); !good) return good;
      continue;
    }
    auto inside = fs::recursive_directory_iterator(at->path(), unknown);
    for (; !unknown && inside != fs::end(inside); inside.increment(unknown)) {
      if (Status good = checkPart(*inside, inside.depth(), part->of_folders); !good) return good;
    }
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
