// How much of a case each tissue of a set takes.
#pragma once

#include <cstdint>
#include <vector>

#include "tissue/tissue_set.h"
#include "volume/hu_histogram.h"

namespace trephine {

struct TissueShares {
  std::vector<std::uint64_t> voxels;  // by tissue of the set
  std::uint64_t none = 0;             // free space
  std::uint64_t all = 0;
  double voxel_mm3 = 0.0;

  double percent(std::size_t tissue) const {
    return all == 0 ? 0.0 : 100.0 * double(voxels[tissue]) / double(all);
  }
  double millilitres(std::size_t tissue) const { return double(voxels[tissue]) * voxel_mm3 / 1000.0; }
};

// Each voxel is of the tissue that classify() says. `set` is placed in the case whose histogram,
// with its labels, this is. Pure; a millisecond or two.
TissueShares sharesOf(const TissueSet& set, const HuHistogram& histogram);

}  // namespace trephine
