// A CT of a head that a scanner might have made: as compressible as one, and every bit known.
#pragma once

#include <cstdint>

#include "base/progress.h"
#include "base/result.h"
#include "volume/volume.h"

namespace trephine::bench {

// The head of the cranium phantom, 230 x 230 x 180 mm, with the noise of a CT: standard deviation
// 15 HU, neighbours within a slice correlated by 0.44 (a head CT with a bone kernel: 13 HU, 0.25 to
// 0.53). All of it comes from formulas in whole numbers, so the bits are the same everywhere.
// HU -1024 to 3071. Errors: BAD_ARGUMENT (checkSeriesSize), CANCELLED, OUT_OF_MEMORY.
Result<Volume> makeNoisyCt(const Index3& size, const Progress& progress);

// A number that looks random and is the same everywhere.
std::uint64_t hashedNumber(std::uint64_t n);

}  // namespace trephine::bench
