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

// [{name, ml, cut_ml}]
Json toJson(const std::vector<CutStructure>& structures);
// "liver: 3.2 mL of 1450 mL cut", a line for each that was cut, in the same order.
std::vector<std::string> linesOf(const std::vector<CutStructure>& structures);

}  // namespace trephine
