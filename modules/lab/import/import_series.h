// CT series of which every voxel is known, as this program writes them: what the import is measured
// on.
#pragma once

#include <filesystem>
#include <functional>
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

struct ImportSeries {
  std::vector<std::string> names;
  Index3 size{512, 512, 300};  // of each (checkSeriesSize)
  int scan_series = 10;        // 1 to 1000, each in a folder of its own; their headers are read
  int scan_slices = 300;       // 2 to 2048, of each of those; 64 x 64 voxels
};

// BAD_ARGUMENT unless edges are of 2 to 2048 voxels, and all are at most 2^28.
Status checkSeriesSize(const Index3& size);

// A head's 230 x 230 x 180 mm around the origin, axes along the patient's.
GridGeometry headGeometry(const Index3& size);

// Makes `folder` / its name for each series and `folder` / "scan" / 1, 2 and so on for the scan,
// always; returns what each named one holds, in their order. Sizes and counts are not checked here.
// Errors: CANNOT_WRITE, CANCELLED; what was written until then stays.
using SeriesWriter = std::function<Result<std::vector<KnownVolume>>(
    const ImportSeries& series, const std::filesystem::path& folder, const Progress& progress)>;

// The cranium phantom, explicit little endian, slope 1: "int16" in signed words with intercept 0,
// "u12" in unsigned ones with -1024, as any other name. A SeriesWriter.
Result<std::vector<KnownVolume>> writeOwnSeries(const ImportSeries& series,
                                                const std::filesystem::path& folder,
                                                const Progress& progress);

}  // namespace trephine
