// What an edit has made of a set, and edits that keep it possible. Pure.
#pragma once

#include <string>
#include <vector>

#include "tissue/tissue_set.h"

namespace trephine {

// Both ends included.
struct HuRange {
  int low = 0;
  int high = 0;
  bool operator==(const HuRange&) const = default;
};
// Of `span`, in rising order, the HU that no tissue without a label holds: free space there.
std::vector<HuRange> freeHu(const TissueSet& set, HuRange span);

// The HU without a tissue between the lowest and the highest that one of any place has, or has in
// `declared`.
std::vector<HuRange> lostHu(const TissueSet& set, const TissueSet& declared);

// A range of HU that another tissue of the same place holds already.
struct HuOverlap {
  std::size_t other = 0;  // of the set
  HuRange range;
  bool operator==(const HuOverlap&) const = default;
};
// What the tissue would share if it were `wanted`, in rising order.
std::vector<HuOverlap> overlapsOf(const TissueSet& set, std::size_t tissue, const Tissue& wanted);

enum class RangeEnd { low, high };
// The tissue with one end of its range at `hu`, or as near as leaves it one HU and takes none of
// another tissue of its place. `with_neighbour`: where the range of another one touches this end,
// that goes along, as far as leaves that one HU too. A valid set stays one. Ranges that change are
// "tuned here", those that are as in `declared` cite its source.
TissueSet withThreshold(const TissueSet& set, std::size_t tissue, RangeEnd end, int hu,
                        bool with_neighbour, const TissueSet& declared);

// The set with the ranges of another of the same tissues, and where those come from.
TissueSet withRangesOf(const TissueSet& set, const TissueSet& ranges);
// The tissue restricted to a structure, or to none (empty). What stands in on a case without it is
// as in `declared`. Alone in a structure it is all of it, whatever HU.
Tissue inStructure(const TissueSet& set, const Tissue& tissue, const std::string& structure,
                   const TissueSet& declared);

// The tissue with this value of a number as a person enters it; what differs by less than
// `least` is the same. A number that is as in `declared` is that one whole, another is tuned here.
// 0 gives up one that `declared` does not give either; of the two that say what cutting costs, the
// other one is then as in `declared`, and 0 stays where it has none.
Tissue withNumber(const Tissue& tissue, const TissueNumber& number, double value, double least,
                  const Tissue& declared);
// The tissue with another source of a number that it has: what was known by the old one goes, and
// is back where the number is as in `declared`.
Tissue withSource(const Tissue& tissue, const TissueNumber& number, const std::string& source,
                  const Tissue& declared);

// One more, of any voxel, first of the list: in the widest free range of what is no air, or, where
// there is none, in the topmost 100 HU of the widest within kCtHu. Error: NO_ROOM.
constexpr HuRange kCtHu{-1024, 3071}, kNoAirHu{-200, 3071};
Result<TissueSet> withNewTissue(const TissueSet& set);
// What it enclosed is enclosed by none. Error: LAST_TISSUE.
Result<TissueSet> withoutTissue(const TissueSet& set, std::size_t tissue);

// What a set of one's own begins with: soft tissue, and bone from the common threshold on.
TissueSet startingSet(const std::string& name);

}  // namespace trephine
