#include "machine/commission/disk_check.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>

#include "base/codes.h"
#include "base/descriptor.h"
#include "base/file.h"
#include "base/tr.h"

namespace trephine {

namespace {

using DiskClock = std::chrono::steady_clock;
constexpr double kBytesOfMB = 1e6, kBytesOfGB = 1e9;

double secondsSince(DiskClock::time_point begun) {
  return std::chrono::duration<double>(DiskClock::now() - begun).count();
}

CommissionCheck written(const std::filesystem::path& into, std::size_t bytes, double most_s,
                        const Progress& progress) {
  const auto failed = [&](int error) {
    return notMeasured("disk_write", Fitness::fail, writeError(into, error));
  };
  const std::string file = (into / (".trephine-commission-" + std::to_string(::getpid()))).string();
  const Descriptor opened(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (!opened.ok()) return failed(errno);
  ::unlink(file.c_str());
  std::vector<char> block(4'000'000);
  for (std::size_t i = 0; i < block.size(); ++i) block[i] = char(i * 2654435761U >> 13);
  const auto begun = DiskClock::now();
  std::size_t done = 0;
  int error = 0;
  while (done < bytes && error == 0 && !progress.cancelled() && secondsSince(begun) < most_s) {
    const ssize_t n = ::write(opened.get(), block.data(), std::min(block.size(), bytes - done));
    if (n < 0 && errno != EINTR) error = errno;
    done += std::size_t(std::max<ssize_t>(n, 0));
    if (error == 0 && ::fdatasync(opened.get()) != 0)
      error = errno;  // as it goes: the time is kept to
  }
  if (error != 0) return failed(error);
  return judged("disk_write", double(done) / kBytesOfMB / std::max(secondsSince(begun), 1e-6));
}

}  // namespace

std::vector<CommissionCheck> checkDisk(const std::filesystem::path& folder, std::size_t bytes,
                                       double most_s, const Progress& progress,
                                       bool has_to_be_there) {
  std::error_code ec;
  if (has_to_be_there && !std::filesystem::is_directory(folder, ec)) {
    const Error why{code::kMissingFolder, tr("This folder is not there"), folder.string(),
                    tr("Check its name in /etc/trephine/settings.json, and whether its disk is "
                       "connected")};
    return {notMeasured("disk_room", Fitness::fail, why),
            notMeasured("disk_write", Fitness::fail, why)};
  }
  std::filesystem::path existing = std::filesystem::absolute(folder, ec);
  while (!std::filesystem::exists(existing, ec) && existing.has_parent_path() &&
         existing != existing.parent_path()) {
    existing = existing.parent_path();
  }
  // Of a shared folder every account may write to its recordings alone.
  if (std::filesystem::is_directory(existing / "sessions", ec)) existing /= "sessions";
  const std::filesystem::space_info space = std::filesystem::space(existing, ec);
  if (ec) {
    const Error why = writeError(folder, ec.value());
    return {notMeasured("disk_room", Fitness::fail, why),
            notMeasured("disk_write", Fitness::fail, why)};
  }
  const bool there = std::filesystem::exists(folder, ec);
  constexpr std::uintmax_t kLeast = 4'000'000;  // of less no speed can be told
  return {
      judged("disk_room", double(space.available) / kBytesOfGB,
             there ? "" : tr("the folder is not there yet: of the disk that it would be on")),
      space.available < kLeast
          ? notMeasured("disk_write", Fitness::fail, writeError(folder, ENOSPC))
          : written(existing, std::min<std::size_t>(bytes, space.available / 4), most_s, progress)};
}

}  // namespace trephine
