// A planned series -> its voxels.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "imaging/common/detail/hu_sanity_check.h"
#include "imaging/common/detail/stored_values.h"
#include "imaging/series/detail/series.h"
#include "volume/volume.h"

namespace trephine {

struct Assembly {
  Volume volume;
  HuCounts counts;
  bool high_bits = false;  // compressed slices have bits above the stored ones, and no overlay does
  HuSanityCheck look;      // at the slices before anything was interpolated
  struct Unreadable {
    std::size_t slice;  // in Series::slices
    std::string why;
  };
  std::vector<Unreadable> unreadable;  // where there are any, the volume is not complete
  bool vanished = false;  // the whole source, rather than one slice or the other, while it was read
};

// Reads the plan's slices on several threads, straight into the volume where nothing is to be
// interpolated. Errors: OUT_OF_MEMORY, CANCELLED.
Result<Assembly> assemble(const Series& series, const SeriesPlan& plan, const Progress& progress);

}  // namespace trephine
