#include "imaging/series/detail/scan.h"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>

#include "base/codes.h"
#include "base/file.h"
#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/source_watch.h"
#include "imaging/common/detail/text.h"
#include "imaging/common/workers.h"
#include "imaging/dicom/detail/dicom_values.h"
#include "imaging/dicom/detail/dicomdir.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr int kDeepestFolder = 32;

struct FoundFile {
  fs::path path;
  std::uint64_t bytes;
};

// Walks the folders; keeps regular files and counts everything else.
class Walk {
 public:
  Walk(ScannedFiles& result, const Progress& progress) : result_(result), progress_(progress) {}

  void visit(const fs::path& path, int depth) {
    if (progress_.cancelled()) return;
    struct stat status;
    if (::stat(path.c_str(), &status) != 0) {
      ++result_.files_seen;
      skip(tr("the file could not be opened"));
      return;
    }
    const bool first_visit = visited_.emplace(status.st_dev, status.st_ino).second;
    if (S_ISDIR(status.st_mode)) {
      if (first_visit) visitFolder(path, depth);
      return;
    }
    ++result_.files_seen;
    if (!S_ISREG(status.st_mode)) {
      skip(tr("not a regular file"));
    } else if (!first_visit) {
      skip(tr("the same file under another name"));
    } else {
      files_.push_back({path, std::uint64_t(status.st_size)});
    }
  }

  const std::vector<FoundFile>& files() const { return files_; }

 private:
  void visitFolder(const fs::path& folder, int depth) {
    if (depth > kDeepestFolder) {
      skip(tr("a folder more than {} levels deep", kDeepestFolder));
      return;
    }
    std::error_code error;
    std::vector<fs::path> entries;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
      entries.push_back(it->path());
    }
    if (error == std::errc::permission_denied) {
      skip(tr("a folder that you have no right to open"));
    } else if (error) {
      skip(tr("a folder that could not be opened"));
    }
    std::ranges::sort(entries, {}, &fs::path::native);
    for (const fs::path& entry : entries) visit(entry, depth + 1);
  }

  void skip(const std::string& reason) { ++result_.skipped[reason]; }

  ScannedFiles& result_;
  const Progress& progress_;
  std::vector<FoundFile> files_;
  // Device and inode of files and folders, read or not: one file may have many names.
  std::set<std::pair<std::uint64_t, std::uint64_t>> visited_;
};

// Whether all of the header could be read.
bool isWhole(const Result<std::vector<DicomHeader>>& headers) {
  return headers && std::ranges::none_of(headers.value(), [](const DicomHeader& frame) {
           return frame.defect == Defect::cut;
         });
}

// The series that are there so far, and where their files lie, for a person who may choose one. Any
// thread.
class LookedAt {
 public:
  explicit LookedAt(ScanGuide& guide) : guide_(guide) {}

  // Whether the file can be left out: the series that was chosen has none in its folder.
  bool skips(const fs::path& file) {
    const std::optional<std::string> chosen = guide_.chosen();
    if (!chosen) return false;
    const std::lock_guard lock(mutex_);
    const auto folders = folders_.find(*chosen);
    return folders != folders_.end() && !folders->second.contains(file.parent_path());
  }

  void add(const std::vector<DicomHeader>& frames) {
    const DicomHeader& first = frames.front();
    const std::lock_guard lock(mutex_);
    const auto [folders, is_new] = folders_.try_emplace(first.series_uid);
    folders->second.insert(first.file.parent_path());
    if (is_new) {
      found_.push_back(
          {first.series_uid, first.description, first.modality, 0, screenNames(first)});
    }
    std::ranges::find(found_, first.series_uid, &FoundSeries::uid)->slices += int(frames.size());
    const auto now = Clock::now();
    if (now - told_ < kTellEvery) return;
    told_ = now;
    guide_.tell(found_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kTellEvery{200};

  ScanGuide& guide_;
  std::mutex mutex_;
  std::vector<FoundSeries> found_;  // in the order in which they were
  std::map<std::string, std::set<fs::path>> folders_;
  Clock::time_point told_{};
};

// The files whose names stand in a header beside them: voxels of a volume in several files.
std::set<fs::path> namedByHeaders(const std::vector<fs::path>& files) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 20;
  std::set<fs::path> named;
  for (const fs::path& file : files) {
    if (file.extension() != ".nhdr" && file.extension() != ".mhd") continue;
    const Result<std::string> text = readWholeFile(file, kMostBytes);
    if (!text) continue;
    std::istringstream words(*text);
    for (std::string word; words >> word;) {
      if (word.ends_with(".raw")) named.insert(file.parent_path() / word);
    }
  }
  return named;
}

}  // namespace

ScreenNames screenNames(const DicomHeader& header) {
  std::string patient = header.patient[0] + header.patient[1] + header.patient[2];
  return {std::move(patient), header.study_uid, header.patient_name, header.study_text};
}

Result<ScannedFiles> scanFiles(const fs::path& path, const Progress& progress, ScanGuide* guide) {
  std::error_code error;
  if (!fs::exists(path, error)) {
    return Error{code::kMissingFolder, tr("The folder does not exist or may not be opened"),
                 cleanUtf8(path.string()), tr("Check the name and that you may read it")};
  }
  // Its dictionary takes as long to load as the folders to walk. Workers wait for it.
  const auto set_up = std::async(setUpDcmtk);
  ScannedFiles result;
  progress.at(0.0, tr("Looking for files"));
  Walk walk(result, progress);
  std::vector<fs::path> named;
  if (fs::is_regular_file(path, error)) named = filesOfDicomDir(path, progress);
  if (named.empty()) {
    const bool stale = isDicomDir(path);
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    walk.visit(stale ? folder : path, 0);
  }
  for (const fs::path& file : named) walk.visit(file, 0);

  const std::vector<FoundFile>& files = walk.files();
  SourceWatch watch;
  std::optional<LookedAt> looked;
  if (guide) looked.emplace(*guide);
  std::vector<std::optional<Result<std::vector<DicomHeader>>>> headers(files.size());
  const Status read =
      forEachFile(files.size(), progress, {0.0, 0.99, tr("Reading headers")}, [&](std::size_t i) {
        const auto& [file, bytes] = files[i];
        if (looked && looked->skips(file)) return;
        const std::size_t number = watch.begin();
        headers[i] = readDicomHeaders(file, bytes, progress);
        watch.end(number, file, bytes, isWhole(*headers[i]));
        if (looked && *headers[i]) looked->add(headers[i]->value());
      });
  if (!read) return read.error();
  if (watch.vanished() || !fs::exists(path, error)) {
    return Error{
        code::kSourceVanished, tr("The source vanished while its files were looked through"),
        cleanUtf8(path.string()), tr("Plug it in or connect it again, then open it again")};
  }

  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!headers[i]) {
      ++result.not_looked_at;
      result.folders_left.insert(files[i].path.parent_path());
      continue;
    }
    auto& frames = *headers[i];
    if (frames) {
      ++result.dicom_files;
      std::ranges::move(frames.value(), std::back_inserter(result.headers));
    } else if (frames.error().code != code::kUnreadableFile && isVolumeFile(files[i].path) &&
               files[i].bytes > 0) {
      result.volume_files.push_back(files[i].path);
    } else {
      ++result.skipped[frames.error().what];
      const bool cut = frames.error().code == code::kCutShort;
      if (files[i].bytes == 0 || cut) ++result.empty_files[files[i].path.parent_path()];
      if (frames.error().code == code::kPacked) {
        result.packed.insert(frames.error().what);
        result.archives.push_back(files[i].path);
      }
    }
    headers[i].reset();
  }
  std::ranges::sort(result.headers, {},
                    [](const DicomHeader& h) { return std::tie(h.sop_instance, h.frame, h.file); });
  std::ranges::sort(result.volume_files);
  const std::vector<fs::path> listed = result.volume_files;
  const std::set<fs::path> of_headers = namedByHeaders(listed);
  const auto parts = std::erase_if(result.volume_files, [&](const fs::path& file) {
    const auto other = fileItBelongsTo(file);
    return of_headers.contains(file) || (other && std::ranges::binary_search(listed, *other));
  });
  if (parts > 0) result.skipped["a part of a volume that another file stands for"] = int(parts);
  return result;
}

}  // namespace trephine
