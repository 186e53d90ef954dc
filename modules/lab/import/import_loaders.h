// Programs that read a folder of CT: this one, and a plain read of the bytes. Each runs as a child
// process on its own.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "base/system.h"
#include "lab/import/import_series.h"

namespace trephine {

struct ImportSample {
  double seconds = 0.0;
  double peak_rss_mb = 0.0;              // of the whole process
  std::optional<double> above_start_mb;  // peak above what the program had at its start
};

// What one run of a loader gave: a sample for each of its names, or why there is none.
struct LoaderRun {
  std::vector<ImportSample> samples;
  std::optional<bool> correct;  // every voxel is as known; nothing where no volume was compared
  std::string problem;          // empty: all went well
};

struct LoaderTask {
  const std::filesystem::path& folder;  // of the series
  const std::filesystem::path& empty;   // a folder for what is written; goes away after the run
  const KnownVolume* known;             // null where the volume need not be compared
  const Progress& progress;
};

struct Loader {
  std::vector<std::string> names;  // of its figures
  int threads = 1;
  std::string missing;  // why it cannot run at all; empty: it can
  // Errors: CANCELLED, CANNOT_RUN.
  std::function<Result<LoaderRun>(const LoaderTask& task)> run;
};

struct OwnProgram {
  std::filesystem::path file = labProgram();         // whose import it is
  std::filesystem::path measure = measureProgram();  // whose plain read it is
  double limit_s = 120.0;                            // for one run
};

// "trephine" (scan + read as `import --json` says), "trephine command" (its wall time without the
// hash that only the report needs), "floor" and "floor kept" (read_floor.h).
std::vector<Loader> ownLoaders(const OwnProgram& program);
// Headers alone, of all files: "trephine" (its report's scan).
Loader ownScanner(const OwnProgram& program);

// For a run's problem.
std::string tookTooLong(double limit_s);
LoaderRun failedRun(std::string why);

}  // namespace trephine
