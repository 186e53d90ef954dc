#include "exercise/tissue_shares.h"

namespace trephine {

TissueShares sharesOf(const TissueSet& set, const HuHistogram& histogram) {
  TissueShares shares;
  shares.voxels.assign(set.tissues.size(), 0);
  shares.all = histogram.voxels;
  shares.voxel_mm3 = histogram.voxel_mm3;
  const TissueTable table = tissueTable(set);
  for (const HuHistogram::Row& row : histogram.rows) {
    for (std::size_t h = 0; h < row.counts.size(); ++h) {
      if (row.counts[h] == 0) continue;
      const int of = classify(table, double(histogram.low_hu) + double(h), row.label);
      (of < 0 ? shares.none : shares.voxels[std::size_t(of)]) += row.counts[h];
    }
  }
  return shares;
}

}  // namespace trephine
