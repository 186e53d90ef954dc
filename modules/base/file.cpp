#include "base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "base/codes.h"
#include "base/descriptor.h"
#include "base/shared_folder.h"
#include "base/stretched_hash.h"
#include "base/tr.h"

namespace trephine {

namespace fs = std::filesystem;

namespace {

// Keeps the target's extension.
fs::path temporaryFor(const fs::path& target) {
  const fs::path name = target.filename();
  std::string extension = name.extension().string();
  if (extension == ".gz") extension = name.stem().extension().string() + extension;
  fs::path temporary = target;
  // Nobody can lay a link where it will be.
  const Result<std::string> random = randomHex(4);
  return temporary.replace_filename("." + name.string() + ".part" + std::to_string(::getpid()) +
                                    (random ? "-" + *random : "") + extension);
}

// Makes the data durable, and reports the errors that a full disk delays until now.
bool syncToDisk(const fs::path& file) {
  int fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  bool ok = ::fsync(fd) == 0;
  return ::close(fd) == 0 && ok;
}

}  // namespace

Status replaceFile(const fs::path& target, const std::function<Status(const fs::path&)>& write) {
  const fs::path temporary = temporaryFor(target);
  Status written = write(temporary);
  std::error_code ec;
  if (!written) {
    fs::remove(temporary, ec);
    return written;
  }
  if (!syncToDisk(temporary)) {
    const int error = errno;
    fs::remove(temporary, ec);
    return writeError(target, error);
  }
  fs::rename(temporary, target, ec);
  if (ec) {
    const int error = ec.value();
    fs::remove(temporary, ec);
    return writeError(target, error);
  }
  giveToGroup(target);
  return {};
}

Error writeError(const fs::path& target, int error) {
  return Error{code::kCannotWrite,
               tr("The file could not be written: {}",
                  (error ? std::strerror(error) : tr("unknown reason"))),
               target.string(), tr("{}; nothing that was there is lost", afterFailedWrite(error))};
}

std::string afterFailedWrite(int error) {
  if (error == ENOSPC || error == EDQUOT || error == EFBIG) {
    return tr("Free some space, or choose another place");
  }
  if (error == EACCES || error == EPERM || error == EROFS) {
    return tr("Choose a place where you may write");
  }
  return tr("Choose another place");
}

Status checkFolderOf(const fs::path& file, const std::string& option) {
  std::error_code ec;
  if (fs::is_directory(file.has_parent_path() ? file.parent_path() : ".", ec)) return {};
  return Error{code::kMissingFolder, tr("There is no folder for this file"), file.string(),
               tr("Make it, or give {} another place", option)};
}

Status checkNewFile(const fs::path& file, const std::string& option) {
  std::error_code ec;
  const fs::file_status there = fs::symlink_status(file, ec);
  if (fs::exists(there)) {
    return Error{code::kCannotWrite,
                 fs::is_directory(there)
                     ? tr("This is a folder, not a new file")
                     : tr("There is something of this name already, which would be lost"),
                 file.string(), tr("Give {} a name that is not taken", option)};
  }
  if (Status folder = checkFolderOf(file, option); !folder) return folder;
  const fs::path temporary = temporaryFor(file);
  if (!Descriptor(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600)).ok()) {
    return writeError(file, errno);
  }
  fs::remove(temporary, ec);
  return {};
}

Result<std::string> readWholeFile(const fs::path& file, std::size_t most_bytes) {
  const std::string check = tr("Check the name and that you may read it");
  const auto failed = [&](Code code, int error) {
    return Error{code, tr("The file cannot be read: {}", std::strerror(error)), file.string(),
                 check};
  };
  // Opening a pipe would wait for its writer without O_NONBLOCK, which a regular file ignores.
  const Descriptor opened(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (!opened.ok()) {
    return failed(errno == ENOENT || errno == ENOTDIR ? code::kMissingFile : code::kCannotRead,
                  errno);
  }
  struct stat of {};
  if (::fstat(opened.get(), &of) != 0) return failed(code::kCannotRead, errno);
  if (!S_ISREG(of.st_mode)) {
    return Error{code::kNoFile, tr("This is no file but a folder, a pipe or a device"),
                 file.string(), check};
  }
  const Error too_large{code::kTooLarge, tr("The file is larger than {} MB", most_bytes >> 20),
                        file.string(), tr("Choose another file")};
  if (std::uintmax_t(of.st_size) > most_bytes) return too_large;
  std::string text(std::size_t(of.st_size), '\0');
  std::size_t got = 0;
  while (got < text.size()) {
    const ssize_t part = ::read(opened.get(), text.data() + got, text.size() - got);
    if (part < 0 && errno == EINTR) continue;
    if (part < 0) return failed(code::kCannotRead, errno);
    if (part == 0) break;  // it became shorter meanwhile
    got += std::size_t(part);
  }
  text.resize(got);
  return text;
}

Status writeTextFile(const fs::path& target, std::string_view text) {
  return replaceFile(target, [&](const fs::path& temporary) -> Status {
    errno = 0;
    std::ofstream out(temporary, std::ios::binary);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    if (!out) return writeError(target, errno);
    return {};
  });
}

Status tryRoom(const fs::path& folder, std::size_t bytes) {
  const fs::path file = folder / (".trephine-room-" + std::to_string(::getpid()));
  const Status fits = writeTextFile(file, std::string(bytes, ' '));
  if (!fits) {
    return Error{fits.error().code, fits.error().what, folder.string(), fits.error().next};
  }
  std::error_code ec;
  fs::remove(file, ec);
  return {};
}

Status makeFolder(const fs::path& folder) {
  std::error_code ec;
  fs::create_directories(folder, ec);
  const std::string reason = ec ? ec.message() : tr("a file is in its place");
  if (ec || !fs::is_directory(folder, ec)) {
    return Error{code::kCannotWrite, tr("The folder could not be made: {}", reason),
                 folder.string(), tr("Choose another folder")};
  }
  return {};
}

Result<fs::path> temporaryFolder() {
  const char* named = std::getenv("TMPDIR");
  const bool given = named && *named;
  const fs::path folder = given ? named : "/tmp";
  std::error_code ec;
  if (fs::is_directory(folder, ec)) return folder;
  return Error{code::kNoTemporaryFolder, tr("There is no folder for temporary files"),
               (given ? "TMPDIR=" : "") + folder.string(),
               tr("Set TMPDIR to a folder that you may write to")};
}

}  // namespace trephine
