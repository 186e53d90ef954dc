// How alike two label maps of one grid are, structure by structure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "volume/label_map.h"

namespace trephine {

struct Likeness {
  double dice = 0.0;     // 2 |A and B| / (|A| + |B|); 1 where both are empty
  double hd95_mm = 0.0;  // the greater of the two 95th percentiles, border to border, the scan's
                         // faces too; NaN where one of them is empty
  double ml_a = 0.0, ml_b = 0.0;
};

// Of the voxels with the label `of_a` in `a` and `of_b` in `b`, by their places in the patient:
// axes may come in another order or run the other way. Errors: OTHER_GRID where the voxels differ.
Result<Likeness> likeness(const LabelMap& a, std::uint8_t of_a, const LabelMap& b,
                          std::uint8_t of_b);

// By name, in the order of the list: those of `after` that `before` has not, or with other voxels,
// another name or colour; and those that `after` has no voxel of. Null: none. Other geometries are
// two maps that share nothing.
struct ChangedStructures {
  std::vector<std::string> changed, gone;
};
ChangedStructures changedStructures(const LabelMap* before, const LabelMap* after);

}  // namespace trephine
