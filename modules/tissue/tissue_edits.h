// What an edit has made of a set.
#pragma once

#include <vector>

#include "tissue/tissue_set.h"

namespace trephine {

// Sources included.
bool sameSet(const TissueSet& a, const TissueSet& b);

// Both ends included.
struct HuRange {
  int low = 0;
  int high = 0;
  bool operator==(const HuRange&) const = default;
};
// Of `span`, in rising order, the HU that no tissue without a label holds: free space there.
std::vector<HuRange> freeHu(const TissueSet& set, HuRange span);

}  // namespace trephine
