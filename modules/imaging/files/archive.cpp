#include "imaging/files/detail/archive.h"

#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <map>
#include <memory>

#include "base/codes.h"
#include "base/descriptor.h"
#include "base/file.h"
#include "base/tr.h"
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

// Why an archive is not whole; empty: it is.
using Reason = std::string_view;  // an English sentence that tr() knows

constexpr Reason kDamaged = trLater("an archive that is damaged or cut short");

std::string bytesAt(const fs::path& file, std::uint64_t from, std::size_t count) {
  const Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  std::string bytes(count, '\0');
  const ssize_t got = in.ok() ? ::pread(in.get(), bytes.data(), count, off_t(from)) : 0;
  bytes.resize(std::size_t(std::max<ssize_t>(got, 0)));
  return bytes;
}

// Whether a ZIP or an unpacked tar has its end, which libarchive does not ask for: the end of the
// central directory, up to the file's end; 1024 bytes of nothing.
bool hasItsEnd(const fs::path& file, std::uint64_t bytes, int format) {
  if ((format & ARCHIVE_FORMAT_BASE_MASK) == ARCHIVE_FORMAT_TAR) {
    constexpr std::size_t kEnd = 1024;
    const std::string end = bytes < kEnd ? "" : bytesAt(file, bytes - kEnd, kEnd);
    return end.size() == kEnd && end.find_first_not_of('\0') == end.npos;
  }
  if ((format & ARCHIVE_FORMAT_BASE_MASK) != ARCHIVE_FORMAT_ZIP) return true;
  constexpr std::uint64_t kRecord = 22, kLongestComment = 65535;
  const std::uint64_t from = bytes - std::min(bytes, kRecord + kLongestComment);
  const std::string end = bytesAt(file, from, std::size_t(bytes - from));
  return end.rfind("PK\5\6") != end.npos;
}

class Unpacker {
 public:
  // Into folders in `folder`.
  Unpacker(const fs::path& folder, const Progress& progress)
      : whole_folder_(folder), progress_(progress), block_(kBlock) {
    std::error_code ec;
    const fs::space_info room = fs::space(folder, ec);
    room_ = ec ? 0 : room.available / 2;
  }

  std::size_t files() const { return files_; }
  // Of the archive that was unpacked last.
  const fs::path& folder() const { return folder_; }

  // CANCELLED, CANNOT_WRITE.
  Result<Reason> unpack(const fs::path& file, double from, double to) {
    std::error_code ec;
    folder_ = whole_folder_ / std::to_string(++archives_);
    fs::create_directory(folder_, ec);
    if (ec) return writeError(whole_folder_, ec.value());
    const std::uint64_t packed = fs::file_size(file, ec);
    left_ = std::max(kAlways, packed * kMostTimes);
    Archive in(archive_read_new(), archive_read_free);
    // Not all that there are: some would start programs.
    for (const auto support : {archive_read_support_filter_gzip, archive_read_support_filter_bzip2,
                               archive_read_support_filter_xz, archive_read_support_filter_zstd,
                               archive_read_support_format_zip, archive_read_support_format_tar,
                               archive_read_support_format_7zip,
                               archive_read_support_format_raw}) {  // raw: one file, packed
      support(in.get());
    }
    // What was joined of several is read to its end.
    archive_read_set_format_option(in.get(), "tar", "read_concatenated_archives", "1");
    if (archive_read_open_filename(in.get(), file.c_str(), kBlock) != ARCHIVE_OK) {
      return kDamaged;
    }
    folders_.clear();
    Reason reason;
    while (true) {
      if (progress_.cancelled()) return cancelled();
      const double share = double(archive_filter_bytes(in.get(), -1)) / (double(packed) + 1.0);
      progress_.at(from + (to - from) * std::clamp(share, 0.0, 1.0), tr("Unpacking"));
      archive_entry* entry = nullptr;
      const int next = archive_read_next_header(in.get(), &entry);
      if (next < ARCHIVE_WARN || next == ARCHIVE_RETRY) return reason.empty() ? kDamaged : reason;
      const int format = archive_format(in.get());
      const bool packed_tar = archive_filter_count(in.get()) > 1;
      if (next == ARCHIVE_EOF) {
        const bool whole = packed_tar || hasItsEnd(file, packed, format);
        return reason.empty() && !whole ? kDamaged : reason;
      }
      if (archive_entry_is_encrypted(entry)) {
        reason = trLater("an archive that is locked by a password");
        continue;
      }
      if (archive_entry_filetype(entry) != AE_IFREG || archive_entry_hardlink(entry)) continue;
      if (++files_ > kMostFiles) return Reason(trLater("an archive of too many files"));
      const char* given = archive_entry_pathname(entry);
      const fs::path inside =
          format == ARCHIVE_FORMAT_RAW ? file.stem() : fs::path(given ? given : "");
      const fs::path to_file = nameFor(inside);
      Result<Reason> written = write(in.get(), to_file);
      if (!written) return written;
      if (written->empty()) continue;
      fs::remove(to_file, ec);
      reason = *written;
      if (reason != kDamaged) return reason;
    }
  }

 private:
  static Error cancelled() { return {code::kCancelled, tr("The import was cancelled"), "", ""}; }

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
      if (count < 0) return kDamaged;
      if (std::uint64_t(count) > std::min(left_, room_)) {
        return Reason(trLater("an archive that unpacks to far more than it should"));
      }
      left_ -= std::uint64_t(count);
      room_ -= std::uint64_t(count);
      for (la_ssize_t done = 0; done < count;) {
        const ssize_t n = ::write(out.get(), block_.data() + done, std::size_t(count - done));
        if (n < 0 && errno != EINTR) return writeError(folder_, errno);
        if (n > 0) done += n;
      }
    }
  }

  const fs::path whole_folder_;
  fs::path folder_;
  const Progress& progress_;
  std::vector<char> block_;
  std::size_t archives_ = 0;
  std::uint64_t left_ = 0, room_ = 0;  // bytes that this archive, and all, may still unpack to
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
    if (!reason->empty())
      unpacked.not_whole.push_back({unpacker.folder(), tr(reason->data()), *reason == kDamaged});
  }
  unpacked.files = unpacker.files();
  return unpacked;
}

}  // namespace trephine
