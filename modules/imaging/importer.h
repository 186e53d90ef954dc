// Any image folder -> series -> report card -> volume. Today: DICOM in uncompressed transfer
// syntaxes; whatever cannot be read yet is refused by name, never guessed.
//
// Nothing here throws. Reports are for the screen: they may hold a series description, never a
// patient's name, and are not written to disk by this room.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "volume/volume.h"

namespace trephine {

enum class Verdict { pass, repaired, refused };
const char* verdictName(Verdict verdict);

// One thing noticed about a series. `code` is stable (listed in the room's README), `severity` is
// "notice", "repair" or "refusal", `action` says in plain words what was done or what to do.
struct Finding {
  std::string code;
  std::string severity;
  std::string text;
  std::vector<std::string> slices;  // places in mm along the normal, or instance numbers
  std::string action;
};

struct SeriesReport {
  std::string uid;  // "#2", "#3" appended when a Series UID is split
  std::string description;
  std::string modality;
  Verdict verdict = Verdict::refused;
  GridGeometry geometry;                     // of the volume that comes (or would come) out
  std::optional<int> hu_min, hu_max;         // null while the series is not chosen
  std::optional<std::string> volume_sha256;  // null while the series is not chosen
  double tilt_deg = 0.0;
  std::string transfer_syntax;  // its UID
  bool lossy = false;
  std::vector<Finding> findings;
};

struct SkippedFiles {
  std::string reason;
  int count = 0;
};

struct ImportReport {
  std::string path;
  int files_seen = 0;
  int files_read = 0;
  std::vector<SkippedFiles> skipped;
  std::vector<SeriesReport> series;
  std::optional<std::string> chosen;  // uid
  std::optional<Error> error;         // why no volume can come out of it
  struct {
    double scan = 0.0, read = 0.0, hash = 0.0;
  } seconds;
  double start_rss_mb = 0.0, peak_rss_mb = 0.0;
};

// The contract of `trephine-lab import --json`, without schema and build.
Json toJson(const ImportReport& report);

// A scanned folder: headers only. Cheap to keep; reading a series opens its files again.
class CtFolder {
 public:
  // Finds and groups the files. `path` may also be one file. Errors: MISSING_FOLDER, CANCELLED. A
  // folder without a usable series is an answer, not an error: report().error is then EMPTY_FOLDER,
  // NO_CT or ALL_REFUSED, and the report says what was skipped or refused and why.
  static Result<CtFolder> scan(const std::filesystem::path& path, const Progress& progress);

  CtFolder(CtFolder&&) noexcept;
  CtFolder& operator=(CtFolder&&) noexcept;
  ~CtFolder();

  // Every series with its verdict so far; read() completes the chosen one.
  const ImportReport& report() const;
  // The CT series with most slices that is not refused; nothing where none can be read.
  std::optional<std::string> bestSeries() const;
  // Reads one series into a volume and completes its entry in report(). Errors: NO_SUCH_SERIES,
  // the refusal's own code, CANCELLED, or OUT_OF_MEMORY.
  Result<Volume> read(const std::string& uid, const Progress& progress);

 private:
  CtFolder();
  struct Contents;
  std::unique_ptr<Contents> contents_;
};

}  // namespace trephine
