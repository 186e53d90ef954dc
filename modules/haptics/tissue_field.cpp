#include "haptics/tissue_field.h"

namespace trephine {

TissueField::Change TissueField::use(const TissueTable& tissues) {
  bool same_voxels = tissues_.count == tissues.count, same_cuts = same_voxels;
  for (int c = 0; c < tissues.count && same_voxels; ++c) {
    const TissueClass &a = ofClass(c), &b = tissues.classes[std::size_t(c)];
    same_voxels = a.hu_min == b.hu_min && a.hu_max == b.hu_max && a.label == b.label &&
                  a.solid == b.solid;
    same_cuts = same_cuts && same_voxels && a.cuttable == b.cuttable;
  }
  tissues_ = tissues;
  if (same_voxels) return same_cuts ? Change::numbers : Change::cuts;
  lookup_.set(tissues);
  bricks_.markAll();
  return Change::voxels;
}

}  // namespace trephine
