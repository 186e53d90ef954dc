#include "volume/journal_file.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "base/codes.h"
#include "base/file.h"
#include "base/tr.h"

namespace trephine {
namespace {

std::string reason(int code) {
  return code == 0 ? tr("unexpected end of file") : std::generic_category().message(code);
}

// A file in `folder` that no name leads to; -1 with errno when there can be none.
int openUnnamed(const std::filesystem::path& folder) {
  const int unnamed = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (unnamed >= 0) return unnamed;
  // Some file systems have no unnamed files: make one with a name (mode 0600) and take it away.
  std::string name = (folder / ".trephine-journal-XXXXXX").string();
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

// All `bytes`, in as many calls as it takes: `transfer(address, bytes, offset)` is pread or pwrite.
// 0 or the error's code; `done` tells how far it came.
template <class Transfer, class Byte>
int transferAll(Byte* address, std::size_t bytes, std::uint64_t offset, std::size_t& done,
                const Transfer& transfer) {
  done = 0;
  while (done < bytes) {
    const ssize_t count = transfer(address + done, bytes - done, off_t(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    if (count == 0) return 0;
    done += std::size_t(count);
  }
  return 0;
}

}  // namespace

Result<std::unique_ptr<JournalFile>> JournalFile::create(const std::filesystem::path& folder) {
  const int descriptor = openUnnamed(folder);
  if (descriptor < 0) {
    return Error{code::kCannotWrite,
                 tr("The journal of what is removed cannot be kept on disk: {}", reason(errno)),
                 folder.string(), afterFailedWrite(errno)};
  }
  return std::unique_ptr<JournalFile>(new JournalFile(descriptor, folder));
}

JournalFile::JournalFile(int descriptor, std::filesystem::path folder)
    : descriptor_(descriptor), folder_(std::move(folder)) {}

JournalFile::~JournalFile() {
  ::close(descriptor_);
}

Status JournalFile::service(CarveJournal& journal) {
  const Status saved = save(journal.log());
  const Status loaded = load(journal.log());
  return saved.ok() ? loaded : saved;
}

Status JournalFile::save(CarveLog& log) {
  // Twice: what is not saved may go over the ring's end. What comes meanwhile waits for the next
  // call, so that a fast writer cannot hold the recorder here.
  for (int part = 0; part < 2 && !write_failed_; ++part) {
    std::uint64_t first = 0;
    const auto bytes = std::as_bytes(log.unsaved(first));
    std::size_t done = 0;
    const int error = transferAll(bytes.data(), bytes.size(), first * sizeof(CarveEntry), done,
                                  [this](const std::byte* from, std::size_t count, off_t at) {
                                    return ::pwrite(descriptor_, from, count, at);
                                  });
    log.markSaved(first + done / sizeof(CarveEntry));
    if (done == bytes.size()) continue;
    write_failed_ = true;
    return Error{code::kCannotWrite,
                 tr("The journal of what is removed can no longer be written: {}", reason(error)),
                 folder_.string(),
                 tr("{}, and start the session anew; until memory is full removal goes on, and "
                    "undo and rewind work still",
                    afterFailedWrite(error))};
  }
  return {};
}

Status JournalFile::load(CarveLog& log) {
  std::uint64_t first = 0;
  const auto bytes = std::as_writable_bytes(log.pendingLoad(first));
  if (bytes.empty()) return {};
  std::size_t done = 0;
  const int error = transferAll(bytes.data(), bytes.size(), first * sizeof(CarveEntry), done,
                                [this](std::byte* to, std::size_t count, off_t at) {
                                  return ::pread(descriptor_, to, count, at);
                                });
  if (done == bytes.size()) {
    log.markLoaded();
    return {};
  }
  if (read_failed_) return {};
  read_failed_ = true;
  return Error{code::kCannotRead,
               tr("The journal of what is removed cannot be read back: {}", reason(error)),
               folder_.string(), tr("Check the disk; undo and rewind wait until it can be read")};
}

}  // namespace trephine
