#include "volume/cut_structures.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace trephine {

std::vector<CutStructure> cutStructures(const LabelMap& structures, const Volume& before,
                                        const Grid& after) {
  const std::size_t count = before.geometry.voxelCount();
  if (structures.labels.size() != count || after.geometry().voxelCount() != count) return {};
  std::array<std::size_t, 256> all{}, cut{};
  for (std::size_t voxel = 0; voxel < count; ++voxel) {
    const std::uint8_t label = structures.labels[voxel];
    if (label == 0) continue;
    ++all[label];
    if (after.hu(voxel) != before.hu[voxel]) ++cut[label];
  }
  const double voxel_ml = before.geometry.voxelVolume_mm3() / 1000.0;
  std::vector<CutStructure> rows;
  for (const Structure& s : structures.structures) {
    const auto label = std::size_t(s.label);
    if (all[label] == 0) continue;
    rows.push_back({s.name, double(all[label]) * voxel_ml, double(cut[label]) * voxel_ml});
  }
  return rows;
}

Json toJson(const std::vector<CutStructure>& structures) {
  Json rows = Json::array();
  for (const CutStructure& s : structures) {
    rows.push_back({{"name", s.name}, {"ml", s.ml}, {"cut_ml", s.cut_ml}});
  }
  return rows;
}

std::vector<std::string> linesOf(const std::vector<CutStructure>& structures) {
  std::vector<std::string> lines;
  for (const CutStructure& s : structures) {
    if (s.cut_ml <= 0.0) continue;
    // A burr takes hundredths of a mL, an organ has hundreds.
    char numbers[96];
    std::snprintf(numbers, sizeof numbers, ": %.*f mL of %.*f mL cut", s.cut_ml < 1.0 ? 2 : 1,
                  s.cut_ml,
                  s.ml < 10.0    ? 2
                  : s.ml < 100.0 ? 1
                                 : 0,
                  s.ml);
    lines.push_back(s.name + numbers);
  }
  return lines;
}

}  // namespace trephine
