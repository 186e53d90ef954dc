// How many voxels of a case have each HU, apart for each label: what thresholds are set by.
#pragma once

#include <cstdint>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

struct HuHistogram {
  struct Row {
    std::uint8_t label = 0;            // 0: voxels without one, the first row
    std::vector<std::uint32_t> counts;  // of low_hu and those that follow
  };
  int low_hu = 0;  // the lowest and the highest that a voxel has
  int high_hu = -1;
  double voxel_mm3 = 0.0;
  std::uint64_t voxels = 0;  // in all
  std::vector<Row> rows;     // of labels that a voxel has, in rising order

  bool empty() const { return voxels == 0; }
  // Of all labels, in the same places.
  std::vector<std::uint64_t> whole() const;
};

// `labels` are fitted to the volume; null, or of another size: none. Error: CANCELLED. 78 million
// voxels take 0.2 s on two cores.
Result<HuHistogram> histogramOf(const Volume& volume, const LabelMap* labels = nullptr,
                                const Progress& progress = Progress());

}  // namespace trephine
