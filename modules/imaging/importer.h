// Any image folder -> series -> report card -> choices -> volume. Nothing here throws.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "imaging/common/source_identity.h"
#include "imaging/report/report.h"
#include "imaging/report/scan_guide.h"
#include "volume/volume.h"

namespace trephine {

// A scanned folder: headers only. Cheap to keep; reading a series opens its files again.
class CtFolder {
 public:
  // Finds and groups the files. `path` may also be one file. Where it holds archives alone (ZIP,
  // tar, gzip, 7z and the like, at most 16), what they hold is unpacked into the temporary folder
  // for as long as this lives. `guide`, which may be null, is told of the series meanwhile, and may
  // end the scan early (SCAN_STOPPED). Errors: MISSING_FOLDER, CANCELLED, SOURCE_VANISHED. A folder
  // without a usable series is an answer, not an error: report().error is then EMPTY_FOLDER, NO_CT
  // or ALL_REFUSED, and the report says what was skipped or refused and why.
  static Result<CtFolder> scan(const std::filesystem::path& path, const Progress& progress,
                               ScanGuide* guide = nullptr);

  CtFolder(CtFolder&&) noexcept;
  CtFolder& operator=(CtFolder&&) noexcept;
  ~CtFolder();

  // Every series with its verdict so far; read() completes the chosen one.
  const ImportReport& report() const;
  // Whom and what each series of the report is of, in its order. Nothing of it is in the report.
  std::vector<ScreenNames> screenNames() const;
  // What its files say of whom it is, with their own names and those of the folders that they lie
  // in: for the screen, and so that no case is called after any of it. Empty where there is no such
  // series.
  SourceIdentity sourceIdentity(const std::string& uid) const;
  // The volume files that look like label maps of a CT beside them, and the DICOM Segmentations.
  // None without such a CT.
  struct LabelFile {
    std::string name;  // below the folder; of DICOM the series's description, for the screen
    std::filesystem::path file;
    std::string of{};  // uid of the only CT of its study and frame of reference; empty: not known
  };
  std::vector<LabelFile> labelFiles() const;
  // The DICOM CT with most slices that is not refused once `answers` are given, else the largest
  // volume file; where none can be read, the first CT that asks what they answer, else nothing.
  std::optional<std::string> bestSeries(const Answers& answers = {}) const;
  // Whether each answer is one that a series of the folder takes where it asks. Errors: BAD_CHOICE.
  Status checkAnswers(const Answers& answers) const;
  // Reads one series, by its UID or its hash, into a volume and completes its entry in report().
  // Errors: NO_SUCH_SERIES, BAD_CHOICE, BAD_CROP, the refusal's own code (SOURCE_VANISHED among
  // them, where the folder is not there any more), CANCELLED, or OUT_OF_MEMORY. The report then
  // tells what else could be chosen (COUCH, FACE); reading again with the answers does it.
  Result<Volume> read(const std::string& uid, const ImportRequest& request,
                      const Progress& progress);
  // One slice as it is stored, in HU, for thumbnails and previews: of any grey series, refused or
  // not. `index` counts report().series' `slices` along the stack, from 0. Errors: NO_SUCH_SERIES,
  // NO_SUCH_SLICE, NO_PICTURE (colour, or no pixels), UNREADABLE.
  Result<SlicePicture> slice(const std::string& uid, int index,
                             const Progress& progress = Progress()) const;

 private:
  CtFolder();
  struct Contents;
  std::unique_ptr<Contents> contents_;
};

}  // namespace trephine
