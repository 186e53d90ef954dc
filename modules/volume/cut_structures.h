// What was cut of each structure of a case.
#pragma once

#include <string>
#include <vector>

#include "base/json.h"
#include "volume/grid.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

struct CutStructure {
  std::string name;
  double ml = 0.0;      // before anything was cut
  double cut_ml = 0.0;  // of that

  friend bool operator==(const CutStructure&, const CutStructure&) = default;
};

// A row for each structure that has voxels, in the map's order. A voxel is cut where its HU is not
// what it was. All are on one grid, else there are no rows; nobody writes `after` meanwhile.
std::vector<CutStructure> cutStructures(const LabelMap& structures, const Volume& before,
                                        const Grid& after);

// While it is being cut: mm3 of each label, by label, that differ from `before` within the box;
// there is no row for 0, nor for a label of which nothing differs. The box lies in the grid and
// holds all that was cut so far: VolumeMirror has it, touched(), and `now`, which is a copy. It has
// at most `most` voxels, else there are no rows: it is for who asks often.
std::vector<std::pair<int, double>> cutWithin(const LabelMap& structures, const Volume& before,
                                              const Volume& now, const VoxelBox& box,
                                              std::size_t most = 4'000'000);

// [{name, ml, cut_ml}]
Json toJson(const std::vector<CutStructure>& structures);
// "liver: 3.2 mL of 1450 mL cut", a line for each that was cut, in the same order.
std::vector<std::string> linesOf(const std::vector<CutStructure>& structures);

}  // namespace trephine
