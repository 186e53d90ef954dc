// Finds DICOM files whatever their names, and reads their headers.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "imaging/dicom/detail/dicom_file.h"
#include "imaging/report/scan_guide.h"

namespace trephine {

struct ScannedFiles {
  std::vector<DicomHeader> headers;  // sorted by SOP Instance UID, then frame and path
  std::vector<std::filesystem::path> volume_files;   // NIfTI and the like, sorted
  std::vector<std::filesystem::path> archives;       // and packed files, not unpacked
  int dicom_files = 0;                               // that were read
  int files_seen = 0;                                // everything that is not a folder
  int not_looked_at = 0;                             // since a series was chosen before the end
  std::set<std::filesystem::path> folders_left;      // in which those files lie
  std::map<std::string, int> skipped;                // by reason; none names a file
  std::set<std::string> packed;                      // reasons that say that files are packed
  std::map<std::filesystem::path, int> empty_files;  // by folder
};

// `path` is a folder, taken with its subfolders, or one file. Of a DICOMDIR the files that it names
// are taken, or its folder where one of them is not there. Links are followed, each file and folder
// once. `guide` may be null. Errors: MISSING_FOLDER, CANCELLED, OUT_OF_MEMORY, SOURCE_VANISHED.
Result<ScannedFiles> scanFiles(const std::filesystem::path& path, const Progress& progress,
                               ScanGuide* guide);

// What the header says of whom and what it is, for the screen alone.
ScreenNames screenNames(const DicomHeader& header);

}  // namespace trephine
