#include "render/seen_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace trephine {

VoxelBox seenBox(const Volume& volume, const LabelMap* labels, const TissueSet& tissues) {
  constexpr double kMostSamples = 400'000.0;
  constexpr int kWidestStep = 8;
  constexpr int kFewest = 3;  // in a slice
  const GridGeometry& g = volume.geometry;
  const VoxelBox all{{0, 0, 0}, g.size};
  const int step =
      std::clamp(int(std::cbrt(double(g.voxelCount()) / kMostSamples)), 1, kWidestStep);
  const TissueTable table = tissueTable(tissues);
  std::array<std::vector<int>, 3> counts;
  for (std::size_t axis = 0; axis < 3; ++axis) counts[axis].assign(std::size_t(g.size[axis]), 0);
  for (int k = 0; k < g.size[2]; k += step) {
    for (int j = 0; j < g.size[1]; j += step) {
      for (int i = 0; i < g.size[0]; i += step) {
        const std::size_t voxel = g.indexOf(i, j, k);
        const int label = labels ? labels->labels[voxel] : 0;
        const int tissue = classify(table, double(volume.hu[voxel]), label);
        if (tissue < 0 || !(tissues.tissues[std::size_t(tissue)].opacity > 0.0)) continue;
        ++counts[0][std::size_t(i)];
        ++counts[1][std::size_t(j)];
        ++counts[2][std::size_t(k)];
      }
    }
  }
  VoxelBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<int>& of = counts[axis];
    const auto any = [&](int count) { return count >= kFewest; };
    const auto first = std::ranges::find_if(of, any);
    if (first == of.end()) return all;
    const auto last = std::find_if(of.rbegin(), of.rend(), any);
    box.low[axis] = std::max(0, int(first - of.begin()) - step + 1);
    box.high[axis] = std::min(g.size[axis], int(of.rend() - last) + step - 1);
  }
  return box;
}

}  // namespace trephine
