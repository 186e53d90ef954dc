#include "base/file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace trephine {

namespace fs = std::filesystem;

namespace {

Error writeError(const fs::path& target, const std::string& reason) {
  return Error{"CANNOT_WRITE", "The file could not be written: " + reason, target.string(),
               "Check free space and that you may write there; nothing that was there is lost"};
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
  fs::path name = target.filename();
  std::string extension = name.extension().string();
  if (extension == ".gz") extension = name.stem().extension().string() + extension;
  fs::path temporary = target;
  temporary.replace_filename("." + name.string() + ".part" + std::to_string(::getpid()) +
                             extension);

  Status written = write(temporary);
  std::error_code ec;
  if (!written) {
    fs::remove(temporary, ec);
    return written;
  }
  if (!syncToDisk(temporary)) {
    std::string reason = std::strerror(errno);
    fs::remove(temporary, ec);
    return writeError(target, reason);
  }
  fs::rename(temporary, target, ec);
  if (ec) {
    std::string reason = ec.message();
    fs::remove(temporary, ec);
    return writeError(target, reason);
  }
  return {};
}

Status writeTextFile(const fs::path& target, std::string_view text) {
  return replaceFile(target, [&](const fs::path& temporary) -> Status {
    errno = 0;
    std::ofstream out(temporary, std::ios::binary);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    if (!out) return writeError(target, errno ? std::strerror(errno) : "unknown reason");
    return {};
  });
}

Status makeFolder(const fs::path& folder) {
  std::error_code ec;
  fs::create_directories(folder, ec);
  const std::string reason = ec ? ec.message() : "a file is in its place";
  if (ec || !fs::is_directory(folder, ec)) {
    return Error{"CANNOT_WRITE", "The folder could not be made: " + reason, folder.string(),
                 "Choose another folder"};
  }
  return {};
}

Result<fs::path> temporaryFolder() {
  const char* named = std::getenv("TMPDIR");
  const bool given = named && *named;
  const fs::path folder = given ? named : "/tmp";
  std::error_code ec;
  if (fs::is_directory(folder, ec)) return folder;
  return Error{"NO_TEMPORARY_FOLDER", "There is no folder for temporary files",
               (given ? "TMPDIR=" : "") + folder.string(),
               "Set TMPDIR to a folder that you may write to"};
}

}  // namespace trephine
