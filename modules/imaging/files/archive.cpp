#include "imaging/files/archive.h"

#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <map>
#include <memory>

#include "base/descriptor.h"
#include "base/file.h"
#include "base/utf8.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = "trephine-unpacked-";
constexpr std::size_t kBlock = std::size_t{1} << 20;
constexpr std::uint64_t kAlways = std::uint64_t{256} << 20;  // bytes that any archive may hold
constexpr std::uint64_t kMostTimes = 100;                    // CT shrinks to a tenth at best
constexpr std::size_t kMostFiles = 200000;

using Archive = std::unique_ptr<archive, int (*)(archive*)>;

// Why an archive was given up; empty: it was not.
using Reason = std::string;

class Unpacker {
 public:
  Unpacker(const fs::path& folder, const Progress& progress)
      : folder_(folder), progress_(progress), block_(kBlock) {}

  std::size_t files() const { return files_; }

  // CANCELLED, CANNOT_WRITE.
  Result<Reason> unpack(const fs::path& file, double from, double to) {
    std::error_code ec;
    const std::uint64_t packed = fs::file_size(file, ec);
    const fs::space_info room = fs::space(folder_, ec);
    left_ = std::min<std::uint64_t>(std::max(kAlways, packed * kMostTimes), room.available / 2);
    Archive in(archive_read_new(), archive_read_free);
    archive_read_support_filter_all(in.get());
    archive_read_support_format_zip(in.get());
    archive_read_support_format_tar(in.get());
    archive_read_support_format_7zip(in.get());
    archive_read_support_format_raw(in.get());  // one file, packed
    if (archive_read_open_filename(in.get(), file.c_str(), kBlock) != ARCHIVE_OK) {
      return Reason("an archive that is damaged");
    }
    folders_.clear();
    while (true) {
      if (progress_.cancelled()) return cancelled();
      const double share = double(archive_filter_bytes(in.get(), -1)) / (double(packed) + 1.0);
      progress_.at(from + (to - from) * std::clamp(share, 0.0, 1.0), "Unpacking");
      archive_entry* entry = nullptr;
      const int next = archive_read_next_header(in.get(), &entry);
      if (next == ARCHIVE_EOF) return Reason();
      if (next < ARCHIVE_WARN) return Reason("an archive that is damaged");
      if (archive_entry_is_encrypted(entry)) {
        return Reason("an archive that is locked by a password: unpack it first");
      }
      if (archive_entry_filetype(entry) != AE_IFREG || archive_entry_hardlink(entry)) continue;
      if (++files_ > kMostFiles) return Reason("an archive of too many files");
      const char* given = archive_entry_pathname(entry);
      const bool one_file = archive_format(in.get()) == ARCHIVE_FORMAT_RAW;
      const fs::path inside = one_file ? file.stem() : fs::path(given ? given : "");
      Result<Reason> written = write(in.get(), nameFor(inside));
      if (!written || !written->empty()) return written;
    }
  }

 private:
  static Error cancelled() { return {"CANCELLED", "The import was cancelled", "", ""}; }

  // A number; of volumes the file's own name in a folder with a number, since headers name others.
  fs::path nameFor(const fs::path& inside) {
    constexpr std::size_t kLongest = 100;
    const fs::path name = inside.filename();
    const std::string text = name.string();
    const bool plain =
        !text.empty() && text.size() <= kLongest && text[0] != '.' && isOneLine(text);
    const bool of_volume = isVolumeFile(name) || name.extension() == ".json";
    const fs::path numbered = folder_ / std::to_string(files_);
    if (!plain || !of_volume) return numbered;
    const auto [folder, fresh] = folders_.try_emplace(inside.parent_path().string(), 0);
    if (fresh) folder->second = ++made_;
    const fs::path in_folder = folder_ / ("volumes-" + std::to_string(folder->second));
    std::error_code ec;
    fs::create_directory(in_folder, ec);
    return fs::exists(in_folder / name, ec) ? numbered : in_folder / name;
  }

  Result<Reason> write(archive* in, const fs::path& to) {
    const Descriptor out(::open(to.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
    if (!out.ok()) return writeError(folder_, errno);
    while (true) {
      if (progress_.cancelled()) return cancelled();
      const la_ssize_t count = archive_read_data(in, block_.data(), block_.size());
      if (count == 0) return Reason();
      if (count < 0) return Reason("an archive that is damaged");
      if (std::uint64_t(count) > left_) {
        return Reason("an archive that unpacks to far more than it should: unpack it first");
      }
      left_ -= std::uint64_t(count);
      for (la_ssize_t done = 0; done < count;) {
        const ssize_t n = ::write(out.get(), block_.data() + done, std::size_t(count - done));
        if (n < 0 && errno != EINTR) return writeError(folder_, errno);
        if (n > 0) done += n;
      }
    }
  }

  const fs::path& folder_;
  const Progress& progress_;
  std::vector<char> block_;
  std::uint64_t left_ = 0;  // bytes that this archive may still unpack to
  std::size_t files_ = 0, made_ = 0;
  std::map<std::string, std::size_t> folders_;  // of the archive at hand: their numbers
};

}  // namespace

Result<UnpackedArchives> unpack(const std::vector<fs::path>& archives, const Progress& progress) {
  const Result<fs::path> temporary = temporaryFolder();
  if (!temporary) return temporary.error();
  LockedFolder::removeLeft(*temporary, kMark);
  Result<LockedFolder> folder = LockedFolder::make(*temporary, kMark, *temporary);
  if (!folder) return folder.error();
  UnpackedArchives unpacked{*std::move(folder), 0, {}};
  Unpacker unpacker(unpacked.folder.path(), progress);
  for (std::size_t n = 0; n < archives.size(); ++n) {
    const double count = double(archives.size());
    const Result<Reason> reason =
        unpacker.unpack(archives[n], double(n) / count, double(n + 1) / count);
    if (!reason) return reason.error();
    if (!reason->empty()) unpacked.not_whole.push_back(*reason);
  }
  unpacked.files = unpacker.files();
  return unpacked;
}

}  // namespace trephine
