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
  rank();
  if (same_voxels) return same_cuts ? Change::numbers : Change::cuts;
  lookup_.set(tissues);
  bricks_.markAll();
  return Change::voxels;
}

void TissueField::rank() {
  int solid = 0, cuttable = 0;
  for (int c = 0; c < tissues_.count; ++c) {
    solid += ofClass(c).solid != 0;
    cuttable += ofClass(c).solid != 0 && ofClass(c).cuttable != 0;
  }
  firmest_ = -1;
  for (int a = 0; a < tissues_.count; ++a) {
    bool alone = true;
    for (int b = 0; b < tissues_.count; ++b) alone = alone && (b == a || firmer(a, b));
    if (alone) firmest_ = a;
  }
  cuts_of_solid_ = cuttable == 0 ? Cuts::none : cuttable < solid ? Cuts::some : Cuts::all;
}

}  // namespace trephine
