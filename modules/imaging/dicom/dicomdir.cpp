#include "imaging/dicom/detail/dicomdir.h"

#include <cctype>
#include <fstream>
#include <map>
#include <optional>
#include <string>

#include "imaging/common/workers.h"
#include "imaging/dicom/detail/dicom_stream.h"
#include "imaging/dicom/detail/dicom_values.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMediaDirectory = "1.2.840.10008.1.3.10";
constexpr std::uintmax_t kLargest = std::uintmax_t(256) << 20;

std::string lowerCase(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// What folders hold, by name in lower case; each is listed once.
class Folders {
 public:
  std::optional<fs::path> find(const fs::path& folder, const std::string& name) {
    const auto [it, first_time] = folders_.try_emplace(folder);
    std::error_code error;
    if (first_time) {
      for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
           entry.increment(error)) {
        it->second.emplace(lowerCase(entry->path().filename().string()), entry->path());
      }
    }
    const auto found = it->second.find(lowerCase(name));
    if (found == it->second.end()) return std::nullopt;
    return found->second;
  }

 private:
  std::map<fs::path, std::map<std::string, fs::path>> folders_;
};

std::optional<fs::path> resolve(const fs::path& folder, const std::vector<std::string>& parts,
                                Folders& folders) {
  fs::path at = folder;
  for (const std::string& part : parts) {
    // Names as they stand in the folder's list hold neither ".." nor a separator.
    const auto next = folders.find(at, part);
    if (!next) return std::nullopt;
    at = *next;
  }
  std::error_code error;
  if (!fs::is_regular_file(at, error)) return std::nullopt;
  return at;
}

}  // namespace

bool isDicomDir(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return false;
  std::ifstream in(file, std::ios::binary);
  std::string head(1024, '\0');
  in.read(head.data(), std::streamsize(head.size()));
  head.resize(std::size_t(in.gcount()));
  return head.find(kMediaDirectory) != head.npos;
}

std::vector<fs::path> filesOfDicomDir(const fs::path& file, const Progress& progress) {
  std::error_code error;
  if (!isDicomDir(file)) return {};
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (error || bytes > kLargest) return {};
  setUpDcmtk();
  std::vector<fs::path> files;
  // On a worker: a crafted file nests thousands deep.
  const Status done = forEachFile(1, Progress(), {}, [&](std::size_t) {
    DcmFileFormat dicom;
    const std::shared_lock rule(unknownRule());
    DicomStream stream(file, kSliceBounds, &progress);
    dicom.transferInit();
    if (dicom.read(stream, EXS_Unknown, EGL_noChange, kLongestValue).bad()) return;
    Folders folders;
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    for (DcmItem* record : DicomItem(dicom.getDataset()).items(DCM_DirectoryRecordSequence)) {
      const std::string name = valueText(DicomItem(record), DCM_ReferencedFileID);
      if (name.empty()) continue;
      const auto found = resolve(folder, splitValues(name), folders);
      if (!found) {
        files.clear();
        return;
      }
      files.push_back(*found);
    }
  });
  if (!done) return {};
  return files;
}

}  // namespace trephine
