// Programs that read a folder of CT: this one, other people's, and a plain read of the bytes. Each
// runs as a child process on its own.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "volume/volume.h"

namespace trephine {

// What a folder's series is known to hold.
struct KnownVolume {
  GridGeometry geometry;  // axes along the patient's, i to the left, j to the back, k up
  std::string sha256;     // of its voxels (volumeSha256)
};

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

struct Loader {
  std::vector<std::string> names;  // of its figures
  int threads = 1;
  std::string missing;  // why it cannot run at all; empty: it can
  // `known` is null where the volume need not be compared. Errors: CANCELLED, CANNOT_RUN.
  std::function<Result<LoaderRun>(const std::filesystem::path& folder, const KnownVolume* known,
                                  const Progress& progress)>
      run;
};

struct LoaderPlaces {
  std::filesystem::path program;  // trephine-lab
  std::filesystem::path scratch;  // a folder for outputs, each removed after its run
  double limit_s = 120.0;         // for one run
};

// "trephine" (scan + read as `import --json` says), "trephine command" (its wall time without the
// hash that only the report needs), "floor" and "floor kept" (read_floor.h).
std::vector<Loader> ownLoaders(const LoaderPlaces& places);
// Those that write a NIfTI volume from a folder: wall time of the whole command.
std::vector<Loader> peerLoaders(const LoaderPlaces& places);

// Headers alone, of all files: "trephine" (its report's scan) and "gdcmscanner" (wall time).
Loader ownScanner(const LoaderPlaces& places);
Loader peerScanner(const LoaderPlaces& places);

// Whether a volume file holds the known voxels, each in its place in the patient: slices, rows and
// columns may run either way.
bool holdsKnownVoxels(const std::filesystem::path& file, const KnownVolume& known);

}  // namespace trephine
