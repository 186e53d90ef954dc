#include "library/case_folders.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "base/codes.h"
#include "base/disk_room.h"
#include "base/file.h"
#include "base/json.h"
#include "base/shared_folder.h"
#include "base/stretched_hash.h"
#include "base/tr.h"
#include "library/codes.h"

namespace trephine::case_folders {

namespace fs = std::filesystem;

namespace {

// Names of parts begin with what they are: only a whole case has a private file of its own.
constexpr const char* kWholeCase = "case-";
constexpr const char* kSomeFiles = "files-";
constexpr const char* kPartLock = ".lock";

Descriptor openLockFile(const fs::path& file) {
  return Descriptor(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
}

Result<fs::path> newPartName(const Folders& folders, const char* begin) {
  Result<std::string> name = randomHex(8);
  if (!name) return name.error();
  return folders.parts() / (begin + *name);
}

// Of the case.json in a folder: no reader of the whole, since it may be of another version. Nothing
// where it cannot be read.
std::optional<std::string> keyIn(const fs::path& folder) {
  const Result<Json> json = readJsonFile(folder / kCaseFile, Progress(), kMostWrittenBytes);
  if (!json || !json->is_object()) return {};
  const auto key = json->find("names_key");
  return key != json->end() && key->is_string() ? key->get<std::string>() : "";
}

bool isKey(const std::string& key) {
  return !key.empty() && key.find_first_not_of("0123456789abcdef") == key.npos;
}

bool isNamedByACase(const Folders& folders, const std::string& key) {
  std::error_code ec;
  for (fs::directory_iterator it(folders.cases(), ec), end; !ec && it != end; it.increment(ec)) {
    std::error_code unknown;
    if (it->path().filename().string().starts_with('.')) continue;
    if (!fs::is_regular_file(it->path() / kCaseFile, unknown)) continue;
    if (keyIn(it->path()).value_or(key) == key) return true;
  }
  return false;
}

// What a whole case has outside of its folder goes first: a folder that is left behind names it.
// A copy of a case has its key as well, and needs it; so may one that cannot be read.
void discard(const Folders& folders, const fs::path& part) {
  const std::string key = keyIn(part).value_or("");
  const bool whole = part.filename().string().starts_with(kWholeCase);
  if (whole && isKey(key) && !isNamedByACase(folders, key)) folders.removePrivate(key);
  std::error_code ec;
  fs::remove_all(part, ec);
}

}  // namespace

Result<FileLock> FileLock::waitFor(const fs::path& file) {
  using namespace std::chrono_literals;
  Descriptor opened = openLockFile(file);
  if (!opened.ok()) return writeError(file, errno);
  const auto until = std::chrono::steady_clock::now() + kPatience;
  while (::flock(opened.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno == EINTR) continue;
    if (errno != EWOULDBLOCK) return writeError(file, errno);
    if (std::chrono::steady_clock::now() > until) {
      return Error{code::kBusy, tr("Another program does not let go of the storage folder's lock"),
                   file.string(), tr("End that program, then try again")};
    }
    std::this_thread::sleep_for(2ms);
  }
  return FileLock(std::move(opened));
}

std::optional<FileLock> FileLock::tryFor(const fs::path& file) {
  Descriptor opened = openLockFile(file);
  if (!opened.ok() || ::flock(opened.get(), LOCK_EX | LOCK_NB) != 0) return std::nullopt;
  return FileLock(std::move(opened));
}

Status Folders::make() const {
  const fs::path own = storage_ / "private";
  for (const fs::path& folder : {cases(), parts(), own}) {
    if (Status made = makeFolder(folder); !made) return made;
  }
  if (Status may = mayChange(); !may) return may;
  if (isEachOnesOwn(own)) return {};
  struct stat of {};
  const bool ours = ::stat(own.c_str(), &of) == 0 && of.st_uid == ::geteuid();
  if (!ours || (of.st_mode & 0777) == 0700) return {};
  return ::chmod(own.c_str(), 0700) == 0 ? Status() : Status(writeError(own, errno));
}

Status Folders::mayChange() const {
  if (!isGroups(cases()) || ::access(cases().c_str(), W_OK) == 0) return {};
  return Error{code::kCannotWrite,
               tr("This account may look at the cases here, and not change them"),
               storage_.string(),
               tr("Ask whoever keeps this workstation for the group of those who make cases, or "
                  "choose a folder of your own under Settings")};
}

Result<FileLock> Folders::lock() const {
  if (Status may = mayChange(); !may) return may.error();
  return FileLock::waitFor(lockFile());
}

void Folders::putInOrder() const {
  // Its owner's to do: what another made there, root above all, would be that one's.
  struct stat of {};
  if (::stat(cases().c_str(), &of) == 0 && of.st_uid == ::geteuid()) (void)make();
  sweep();
}

void Folders::sweep() const {
  std::error_code ec;
  if (!fs::is_directory(parts(), ec)) return;
  // Who holds it is at work there; the next start sweeps.
  const std::optional<FileLock> list = FileLock::tryFor(lockFile());
  if (!list) return;
  std::vector<fs::path> dead;
  for (fs::directory_iterator it(parts(), ec), end; !ec && it != end; it.increment(ec)) {
    // One without a lock file was a case that is being deleted, or has lost its maker.
    if (fs::exists(it->path() / kPartLock, ec) && !FileLock::tryFor(it->path() / kPartLock)) {
      continue;
    }
    dead.push_back(it->path());
  }
  for (const fs::path& part : dead) discard(*this, part);
}

Status Folders::roomFor(std::uint64_t bytes) const {
  return enoughRoom(storage_, double(bytes), tr("the case"));
}

void Folders::removePrivate(const std::string& key) const {
  std::error_code ec;
  if (isKey(key)) fs::remove(privateFile(key), ec);
}

void Folders::keepPrivateOf(const std::set<std::string>& keys) const {
  std::error_code ec;
  std::vector<std::string> gone;
  for (fs::directory_iterator it(storage_ / "private", ec), end; !ec && it != end;
       it.increment(ec)) {
    const std::string key = it->path().stem().string();
    if (!keys.contains(key)) gone.push_back(key);
  }
  for (const std::string& key : gone) removePrivate(key);
}

Result<Part> Part::make(const Folders& folders, Of what) {
  const Result<FileLock> list = folders.lock();
  if (!list) return list.error();
  if (Status there = folders.make(); !there) return there.error();
  const auto path = newPartName(folders, what == Of::wholeCase ? kWholeCase : kSomeFiles);
  if (!path) return path.error();
  if (Status made = makeFolder(*path); !made) return made.error();
  Result<FileLock> lock = FileLock::waitFor(*path / kPartLock);
  if (!lock) {
    discard(folders, *path);
    return lock.error();
  }
  giveToGroup(*path);
  return Part(folders, *path, *std::move(lock));
}

Part::~Part() {
  drop();
}

void Part::drop() {
  if (!path_.empty()) discard(folders_, std::exchange(path_, {}));
}

Status Part::replace(const char* name, const fs::path& case_folder) const {
  std::error_code ec;
  giveToGroup(path_ / name);
  fs::rename(path_ / name, case_folder / name, ec);
  if (ec) return writeError(case_folder / name, ec.value());
  return syncFolder(case_folder);
}

Status Part::writePrivate(const std::string& key, std::string_view text) const {
  const fs::path file = folders_.privateFile(key), here = path_ / kPrivatePart;
  const int fd = ::open(here.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (fd < 0) return writeError(file, errno);
  std::size_t done = 0;
  int error = 0;
  while (done < text.size() && error == 0) {
    const ssize_t n = ::write(fd, text.data() + done, text.size() - done);
    if (n >= 0) done += std::size_t(n);
    if (n < 0 && errno != EINTR) error = errno;
  }
  if (error == 0 && ::fsync(fd) != 0) error = errno;
  if (::close(fd) != 0 && error == 0) error = errno;
  std::error_code ec;
  if (error == 0) fs::rename(here, file, ec);
  if (ec) error = ec.value();
  if (error != 0) return writeError(file, error);
  return syncFolder(file.parent_path());
}

Status Part::becomeCase(const fs::path& case_folder) {
  std::error_code ec;
  // Nobody sweeps meanwhile: that needs the lock of the list.
  fs::remove(path_ / kPartLock, ec);
  giveToGroup(path_);
  if (Status synced = syncFolder(path_); !synced) return synced;
  fs::rename(path_, case_folder, ec);
  if (ec) return writeError(case_folder, ec.value());
  path_.clear();
  return syncFolder(case_folder.parent_path());
}

Status removeCase(const Folders& folders, const std::string& id) {
  const fs::path folder = folders.caseFolder(id);
  if (Status made = folders.make(); !made) return made;
  const auto part = newPartName(folders, kWholeCase);
  if (!part) return part.error();
  std::error_code ec;
  std::error_code none;
  fs::rename(folder, *part, ec);
  if (ec && fs::symlink_status(folder, none).type() == fs::file_type::not_found) {
    return Error{code::kNoSuchCase, tr("The case is not there any more"), id,
                 tr("Look at the list again")};
  }
  if (ec) {
    Error error = writeError(folder, ec.value());
    error.what = tr("The case could not be deleted: {}", ec.message());
    return error;
  }
  const Status synced = syncFolder(folders.cases());
  discard(folders, *part);
  return synced;
}

}  // namespace trephine::case_folders
