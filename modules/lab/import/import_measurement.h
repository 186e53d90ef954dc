// How fast is a folder of CT read, against a plain read of its bytes?
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "lab/import/import_loaders.h"
#include "lab/import/import_series.h"

namespace trephine {

// One loader (names: import_loaders.h) on one series. Where it gave no figures, skipped_reason says
// why: it is not installed, it refused or failed, or it took too long.
struct ImportRow {
  std::string series;
  std::string loader;
  int threads = 1;
  std::optional<double> seconds_median;
  std::optional<double> peak_rss_mb;     // the largest of all runs
  std::optional<double> above_start_mb;  // the largest of all runs; only our own
  std::optional<bool> correct;           // nothing where the loader makes no volume
  std::string skipped_reason;
};

// One reader of headers on the folder of many series.
struct ScanRow {
  int files = 0;
  std::string loader;
  std::optional<double> seconds_median;
  std::optional<double> peak_rss_mb;
  std::string skipped_reason;
};

struct ImportMeasurement {
  double volume_mb = 0.0;  // of the voxels, MB of 2^20 bytes
  std::vector<ImportRow> rows;
  std::vector<ScanRow> scan;
};

struct ImportOptions {
  ImportSeries series;  // all that there are where it names none
  int repetitions = 5;  // 1 to 100, after one that is not timed
};

// What is measured: series, who makes them, and who reads them.
struct ImportSubjects {
  std::vector<std::string> names;
  SeriesWriter write;
  std::vector<Loader> loaders;   // of each series
  std::vector<Loader> scanners;  // of the headers
};
ImportSubjects ownSubjects(const OwnProgram& program);

// Medians against medians of the same run; nothing where one of the two is missing. Only a volume
// that is right counts as read.
std::optional<double> secondsOf(const ImportMeasurement& measurement, const std::string& series,
                                const std::string& loader);
std::optional<double> ratioOf(std::optional<double> ours, std::optional<double> reference);

// The median and the largest of a loader's samples, put into the row.
ImportRow summarizeImport(ImportRow row, const std::vector<ImportSample>& samples);

// Makes every series in a temporary folder in `out`, which goes away at the end; the loaders then
// take turns. Writes import.csv into `out`. Takes up to 0.4 GB of disk for our own series. Errors:
// BAD_ARGUMENT, CANCELLED, CANNOT_WRITE, CANNOT_RUN, OUT_OF_MEMORY.
Result<ImportMeasurement> measureImport(const ImportOptions& options,
                                        const ImportSubjects& subjects,
                                        const std::filesystem::path& out,
                                        const Progress& progress = Progress());

// {volume_mb, rows:[{series, loader, threads, seconds_median, peak_rss_mb, above_start_mb, correct,
//  skipped_reason}], scan:[{files, loader, seconds_median, peak_rss_mb, skipped_reason}],
//  ratios:{int16_to_floor, int16_to_floor_kept, u12_to_floor, u12_to_floor_kept,
//  command_to_dcm2niix, scan_to_gdcmscanner, compressed:{deflated, rle, jpegls, jpegll, j2k}}};
// null for nothing, as all ratios to other programs are here: tests/bench/import has those.
Json toJson(const ImportMeasurement& measurement);
std::string toText(const ImportMeasurement& measurement);

}  // namespace trephine
