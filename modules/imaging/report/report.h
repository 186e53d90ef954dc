// What an import says of a folder: its series, each with a verdict, findings and questions; and
// what became of the source. Plain data. CtFolder (imaging/importer.h) makes it and takes requests.
//
// A report is for the screen: it may hold a series description and paths, never a patient's name.
// What may leave the machine is the provenance and the page (report_page.h), which hold neither.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/result.h"
#include "imaging/common/source_ids.h"
#include "volume/volume.h"

namespace trephine {

// By the findings, with the answers that were given so far. A series is refused also while a
// question is open whose first option is "refuse": an answer may lift that. So ask its `choices`
// first; seriesState() (imaging/series_state.h) tells which refusals no answer lifts.
enum class Verdict { pass, repaired, refused };
const char* verdictName(Verdict verdict);

// `edit`: the volume was changed as a person asked, which says nothing against the series.
enum class Severity { notice, edit, repair, refusal };
const char* severityName(Severity severity);

// One thing noticed about a series; `action` says in plain words what was done or what to do.
struct Finding {
  Code code;
  Severity severity;
  std::string text;
  std::vector<std::string> slices;  // places in mm along the normal, or instance numbers
  std::string action;
};

// Text and action as sentences, each with one stop, whether or not it came with it.
std::string sentencesOf(const Finding& finding);

// A question that only a person can answer. `options` are what `--choice CODE=OPTION` takes, the
// first is what happens where nobody answers ("refuse" or "keep"); `words` say what each does.
struct Choice {
  Code code;
  std::string question;
  std::vector<std::string> options;
  std::vector<std::string> words;
  // Of each option, where they say more of it: a text for the screen alone, since it may name people,
  // and the slice to show, as CtFolder::slice() numbers them; -1: none.
  std::vector<std::string> on_screen{};
  std::vector<int> shown{};
};

// What was answered: code -> option.
using Answers = std::map<Code, std::string>;

struct ImportRequest {
  Answers answers;                       // a code that the series does not ask for is no error
  std::optional<VoxelBox> crop;          // of the grid that the report states; before the reduction
  int reduction = 1;                     // 1, 2 (half resolution) or 4 (a quarter)
  std::optional<double> most_memory_mb;  // the most for readingMb(); absent: what is free
};

// What a reduction cost, measured against the full resolution (volume/reduce.h).
struct MeasuredLoss {
  double rms_hu = 0.0;
  double p99_hu = 0.0;
  double bone_volume_change_percent = 0.0;
};

// What became of the source: written beside the volume, so it names no patient, path or UID. Hashes
// of UIDs say no more than whether something else is of the same source.
struct Provenance {
  std::string source;           // "DICOM", "NIfTI", ...
  std::string transfer_syntax;  // its name; empty where there is none
  bool lossy = false;
  int slices_used = 0;
  Answers answers;                          // what was done about each question of the series
  std::vector<Code> unanswered;             // codes of those that nobody answered
  std::vector<Code> unused_answers;         // codes of answers to questions that it did not ask
  std::vector<Finding> changes;             // findings of severity repair and edit
  std::optional<VoxelBox> crop;
  int reduction = 1;
  std::optional<MeasuredLoss> loss;
  std::string volume_sha256;
  SourceIds source_ids;  // of the slices that were used, where all agree; none of a volume file
  std::string build;
};

struct SeriesReport {
  std::string uid;  // "#2", "#3" appended when a Series UID is split; of a file "file:" and name
  std::string description;
  std::string modality;
  std::string body_part;
  std::string source = "DICOM";  // or the name of a volume file's format
  Verdict verdict = Verdict::refused;
  GridGeometry geometry;                     // of the volume that comes (or would come) out
  std::optional<int> hu_min, hu_max;         // null while the series is not chosen
  std::optional<std::string> volume_sha256;  // null while the series is not chosen
  double tilt_deg = 0.0;
  std::string transfer_syntax;  // its UID
  bool lossy = false;
  int slices = 0;  // frames or slices found, usable or not
  int phases = 1;
  // What Trephine takes as a whole with the case open and an exercise running on it, or at the peak
  // of reading it where that is more (volume/case_memory.h).
  double memory_mb = 0.0;
  double reading_mb = 0.0;  // of that, at the peak of reading it
  std::vector<Finding> findings;
  std::vector<Choice> choices;  // still open or answered: all that the series asks
};

// The same with its crop and reduction, in MB of 2^20 bytes; `series` is as it was before it was
// read.
double memoryMb(const SeriesReport& series, const ImportRequest& request);
double readingMb(const SeriesReport& series, const ImportRequest& request);

struct SkippedFiles {
  std::string reason;
  int count = 0;
  bool packed = false;  // archives, to be unpacked first
};

struct ImportReport {
  std::string path;
  int files_seen = 0;
  int files_read = 0;
  std::vector<SkippedFiles> skipped;
  std::vector<SeriesReport> series;
  std::optional<std::string> chosen;  // uid
  std::optional<Provenance> provenance;
  std::optional<Error> error;  // why no volume can come out of it
  struct {
    double scan = 0.0, read = 0.0, hash = 0.0;
  } seconds;
  double start_rss_mb = 0.0, peak_rss_mb = 0.0;
};

// Whether a report names its source: path, UIDs, descriptions and formats. Where it is hidden, UIDs
// are their hashes, and the others empty.
enum class Identity { hidden, shown };

// The contract of `trephine-lab import --json`, without schema and build.
Json toJson(const ImportReport& report, Identity identity = Identity::hidden);

// What CtFolder::slice() gives. `spacing_mm` lies between columns, then between rows.
struct SlicePicture {
  int columns = 0, rows = 0;
  Vec3 spacing_mm{1.0};
  std::vector<std::int16_t> hu;  // row by row
};

}  // namespace trephine
