#include "tissue/tissue_edits.h"

#include <algorithm>

namespace trephine {

bool sameSet(const TissueSet& a, const TissueSet& b) {
  return toJson(a) == toJson(b);
}

std::vector<HuRange> freeHu(const TissueSet& set, HuRange span) {
  std::vector<HuRange> held, free;
  for (const Tissue& t : set.tissues) {
    if (t.isAnywhere()) held.push_back({t.hu_min, t.hu_max});
  }
  std::ranges::sort(held, {}, &HuRange::low);
  int next = span.low;  // all below is accounted for
  for (const HuRange& range : held) {
    if (next > span.high) break;
    if (range.low > next) free.push_back({next, std::min(range.low - 1, span.high)});
    next = std::max(next, range.high + 1);
  }
  if (next <= span.high) free.push_back({next, span.high});
  return free;
}

}  // namespace trephine
