#include "tissue/tissue_edits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/tr.h"
#include "tissue/codes.h"

namespace trephine {

namespace {

SourcedNumber tuned(double value) {
  return {value, kOwnSource};
}

// Soft, and easily cut: nothing that surprises a hand before it is set.
Tissue softTissue(const std::string& id, const std::string& name, HuRange hu) {
  Tissue tissue;
  tissue.id = id;
  tissue.name = name;
  tissue.hu_min = hu.low;
  tissue.hu_max = hu.high;
  tissue.hu_source = kOwnSource;
  tissue.opacity = 0.2;
  tissue.damping_Ns_per_m = tuned(3.0);
  tissue.stiffness_N_per_m = tuned(120.0);
  tissue.friction_N = tuned(0.3);
  tissue.cutting_J_per_mm3 = tuned(1e-5);
  return tissue;
}

constexpr std::array<Vec3, 6> kColours{Vec3(0.35, 0.72, 0.65), Vec3(0.85, 0.65, 0.30),
                                       Vec3(0.60, 0.50, 0.85), Vec3(0.80, 0.45, 0.45),
                                       Vec3(0.45, 0.65, 0.90), Vec3(0.70, 0.75, 0.40)};

// The tissue of the same place whose range lies next beyond this end.
std::optional<std::size_t> neighbour(const TissueSet& set, std::size_t tissue, RangeEnd end) {
  const Tissue& own = set.tissues[tissue];
  std::optional<std::size_t> next;
  for (std::size_t i = 0; i < set.tissues.size(); ++i) {
    const Tissue& other = set.tissues[i];
    if (i == tissue || !inSamePlace(own, other)) continue;
    if (end == RangeEnd::low) {
      if (other.hu_max >= own.hu_min) continue;
      if (!next || other.hu_max > set.tissues[*next].hu_max) next = i;
    } else {
      if (other.hu_min <= own.hu_max) continue;
      if (!next || other.hu_min < set.tissues[*next].hu_min) next = i;
    }
  }
  return next;
}

void cite(Tissue& tissue, const Tissue& before, const TissueSet& declared) {
  if (tissue.hu_min == before.hu_min && tissue.hu_max == before.hu_max) return;
  const Tissue* cited = declared.find(tissue.id);
  const bool as_cited =
      cited && cited->hu_min == tissue.hu_min && cited->hu_max == tissue.hu_max;
  tissue.hu_source = as_cited ? cited->hu_source : kOwnSource;
}

}  // namespace

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

std::vector<HuRange> lostHu(const TissueSet& set, const TissueSet& declared) {
  HuRange span{std::numeric_limits<int>::max(), std::numeric_limits<int>::lowest()};
  for (const TissueSet* of : {&set, &declared}) {
    for (const Tissue& tissue : of->tissues) {
      if (!tissue.isAnywhere()) continue;
      span = {std::min(span.low, tissue.hu_min), std::max(span.high, tissue.hu_max)};
    }
  }
  return span.low <= span.high ? freeHu(set, span) : std::vector<HuRange>{};
}

std::vector<HuOverlap> overlapsOf(const TissueSet& set, std::size_t tissue, const Tissue& wanted) {
  std::vector<HuOverlap> overlaps;
  for (std::size_t i = 0; i < set.tissues.size(); ++i) {
    const Tissue& other = set.tissues[i];
    if (i == tissue || !inSamePlace(wanted, other)) continue;
    const HuRange shared{std::max(wanted.hu_min, other.hu_min),
                         std::min(wanted.hu_max, other.hu_max)};
    if (shared.low <= shared.high) overlaps.push_back({i, shared});
  }
  std::ranges::sort(overlaps, {}, [](const HuOverlap& o) { return o.range.low; });
  return overlaps;
}

TissueSet withThreshold(const TissueSet& set, std::size_t tissue, RangeEnd end, int hu,
                        bool with_neighbour, const TissueSet& declared) {
  TissueSet out = set;
  Tissue& own = out.tissues[tissue];
  const std::optional<std::size_t> next = neighbour(set, tissue, end);
  Tissue* other = next ? &out.tissues[*next] : nullptr;
  const bool low = end == RangeEnd::low;
  const bool touches =
      other && (low ? other->hu_max + 1 == own.hu_min : own.hu_max + 1 == other->hu_min);
  const bool along = with_neighbour && touches;
  if (low) {
    const int least = !other ? int(kHuRange.low) : (along ? other->hu_min : other->hu_max) + 1;
    own.hu_min = std::clamp(hu, least, own.hu_max);
    if (along) other->hu_max = own.hu_min - 1;
  } else {
    const int most = !other ? int(kHuRange.high) : (along ? other->hu_max : other->hu_min) - 1;
    own.hu_max = std::clamp(hu, own.hu_min, most);
    if (along) other->hu_min = own.hu_max + 1;
  }
  for (std::size_t i = 0; i < out.tissues.size(); ++i) {
    cite(out.tissues[i], set.tissues[i], declared);
  }
  return out;
}

TissueSet withRangesOf(const TissueSet& set, const TissueSet& ranges) {
  TissueSet out = set;
  for (std::size_t i = 0; i < out.tissues.size(); ++i) {
    const Tissue& of = ranges.tissues[i];
    out.tissues[i].hu_min = of.hu_min;
    out.tissues[i].hu_max = of.hu_max;
    out.tissues[i].hu_source = of.hu_source;
  }
  return out;
}

Tissue inStructure(const TissueSet& set, const Tissue& tissue, const std::string& structure,
                   const TissueSet& declared) {
  Tissue out = tissue;
  out.structure = structure;
  out.label.reset();
  if (structure.empty()) out.shell.reset();
  const Tissue* cited = declared.find(out.id);
  if (cited && cited->structure == structure) out.shell = cited->shell;
  const bool alone = std::ranges::none_of(set.tissues, [&](const Tissue& other) {
    return other.id != out.id && other.structure == structure;
  });
  if (!structure.empty() && alone) {
    out.hu_min = kRemovedHu + 1;
    out.hu_max = kCtHu.high;
    out.hu_source = "whatever HU, where the structure is";
  }
  return out;
}

Tissue withNumber(const Tissue& tissue, const TissueNumber& number, double value, double least,
                  const Tissue& declared) {
  const auto same = [&](double other) { return std::abs(value - other) < least; };
  Tissue out = tissue;
  if (same(number.valueOf(tissue))) return out;
  const SourcedNumber* cited = number.of(declared);
  if (cited && same(cited->value)) {
    number.set(out, *cited);
  } else if (cited || value != 0.0) {
    number.set(out, {value, kOwnSource});
  } else if (!number.isCutting()) {
    number.clear(out);
  } else {
    number.set(out, {0.0, kOwnSource});
    for (const TissueNumber& other : kTissueNumbers) {
      const SourcedNumber* given = other.isCutting() ? other.of(declared) : nullptr;
      if (given) other.set(out, *given);
    }
  }
  return out;
}

Tissue withSource(const Tissue& tissue, const TissueNumber& number, const std::string& source,
                  const Tissue& declared) {
  Tissue out = tissue;
  const double value = number.valueOf(tissue);
  const SourcedNumber* cited = number.of(declared);
  const bool as_cited = cited && cited->value == value && cited->source == source;
  number.set(out, as_cited ? *cited : SourcedNumber{value, source});
  return out;
}

Result<TissueSet> withNewTissue(const TissueSet& set) {
  if (set.tissues.size() >= std::size_t(kMaxTissues)) {
    return Error{code::kNoRoom, tr("A set has at most {} tissues", kMaxTissues), "",
                 tr("Remove one first")};
  }
  std::vector<HuRange> free = freeHu(set, kNoAirHu);
  const bool air = free.empty();
  if (air) free = freeHu(set, kCtHu);
  if (free.empty()) {
    return Error{code::kNoRoom, tr("Every HU from {} to {} has a tissue", kCtHu.low, kCtHu.high),
                 "", tr("Narrow the range of one first, or restrict one to a structure")};
  }
  HuRange widest = *std::ranges::max_element(
      free, {}, [](const HuRange& range) { return range.high - range.low; });
  if (air) widest.low = std::max(widest.low, widest.high - 99);
  int number = 1;
  while (set.find("tissue-" + std::to_string(number))) ++number;
  Tissue tissue = softTissue("tissue-" + std::to_string(number), tr("Tissue {}", number), widest);
  tissue.colour = kColours[std::size_t(number - 1) % kColours.size()];
  TissueSet out = set;
  out.tissues.insert(out.tissues.begin(), std::move(tissue));
  return out;
}

Result<TissueSet> withoutTissue(const TissueSet& set, std::size_t tissue) {
  if (set.tissues.size() < 2) {
    return Error{code::kLastTissue, tr("A set has at least one tissue"), "",
                 tr("Add another one first")};
  }
  TissueSet out = set;
  const std::string gone = out.tissues[tissue].id;
  out.tissues.erase(out.tissues.begin() + std::ptrdiff_t(tissue));
  for (Tissue& t : out.tissues) {
    if (t.within == gone) t.within.clear();
  }
  return out;
}

TissueSet startingSet(const std::string& name) {
  Tissue soft = softTissue("soft", tr("Soft tissue"), {-200, 225});
  soft.colour = Vec3(0.80, 0.50, 0.42);
  Tissue bone = softTissue("bone", tr("Bone"), {226, 3071});
  bone.hu_source = "common CT threshold for bone, 226 HU";
  bone.colour = Vec3(0.93, 0.88, 0.77);
  bone.opacity = 0.9;
  bone.damping_Ns_per_m = tuned(12.0);
  bone.stiffness_N_per_m = tuned(900.0);
  bone.friction_N = tuned(2.0);
  bone.cutting_J_per_mm3 = tuned(0.06);
  bone.solid = true;
  return {name, {bone, soft}};
}

}  // namespace trephine
