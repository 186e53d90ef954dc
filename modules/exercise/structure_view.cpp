#include "exercise/structure_view.h"

#include <algorithm>

namespace trephine {

namespace {

// A label that none of them has.
int nowhereIn(const std::vector<Structure>& structures) {
  int label = int(kLabelRange.high);
  while (label > 1 &&
         std::ranges::any_of(structures, [&](const Structure& s) { return s.label == label; })) {
    --label;
  }
  return label;
}

bool isOf(const Tissue& tissue, const Structure& structure) {
  return tissue.structure.empty() ? tissue.label == structure.label
                                  : sameName(tissue.structure, structure.name);
}

// Of the picture alone: its mechanics are nobody's.
Tissue tissueFor(const Structure& structure, double opacity) {
  Tissue tissue;
  tissue.id = "structure:" + std::to_string(structure.label);
  tissue.name = structure.name;
  tissue.hu_min = int(kHuRange.low);
  tissue.hu_max = int(kHuRange.high);
  tissue.label = structure.label;
  tissue.colour = structure.colour;
  tissue.opacity = opacity;
  return tissue;
}

}  // namespace

std::vector<std::string> tissuesOf(const TissueSet& tissues, const Structure& structure) {
  std::vector<std::string> ids;
  for (const Tissue& tissue : tissues.tissues) {
    if (isOf(tissue, structure)) ids.push_back(tissue.id);
  }
  return ids;
}

SeenTissues withStructures(const TissueSet& tissues, const TissueLooks& looks,
                           const std::vector<Structure>& structures, const StructureLooks& chosen,
                           int first_label) {
  SeenTissues seen{tissues, looks, {}};
  const int nowhere = nowhereIn(structures);
  for (Tissue& tissue : seen.tissues.tissues) {
    if (!tissue.structure.empty()) tissue.label = nowhere;
  }
  std::vector<std::size_t> own;  // those without a tissue of the exercise
  for (std::size_t n = 0; n < structures.size(); ++n) {
    const Structure& of = structures[n];
    const auto found = chosen.find(of.label);
    static const StructureLook kNone;
    const StructureLook& wanted = found != chosen.end() ? found->second : kNone;
    const Tissue* first = nullptr;
    for (Tissue& tissue : seen.tissues.tissues) {
      if (!isOf(tissue, of)) continue;
      tissue.label = of.label;
      if (wanted.opacity) tissue.opacity = *wanted.opacity;
      if (wanted.colour) tissue.colour = *wanted.colour;
      if (!first) first = &tissue;
    }
    SeenStructure& look = seen.structures.emplace_back();
    look.label = of.label;
    if (first) {
      look.look = lookOf(*first, looks);
      look.opacity = first->opacity;
    } else {
      look.look = wanted.look.value_or(TissueLook::shown);
      look.opacity = wanted.opacity.value_or(kSeenOpacity);
      own.push_back(n);
    }
  }
  std::ranges::stable_sort(own, {}, [&](std::size_t n) {
    if (seen.structures[n].look == TissueLook::hidden) return 2;
    return seen.structures[n].label == first_label ? 0 : 1;
  });
  for (const std::size_t n : own) {
    SeenStructure& look = seen.structures[n];
    look.has_room = seen.tissues.tissues.size() < std::size_t(kMaxTissues);
    if (!look.has_room) continue;
    const Tissue& added = seen.tissues.tissues.emplace_back(tissueFor(structures[n], look.opacity));
    seen.looks[added.id] = look.look;
  }
  return seen;
}

void handToTissues(StructureLooks& chosen, TissueLooks& looks, const TissueSet& tissues,
                   const std::vector<Structure>& structures) {
  for (const Structure& structure : structures) {
    const auto found = chosen.find(structure.label);
    if (found == chosen.end() || !found->second.look) continue;
    const std::vector<std::string> ids = tissuesOf(tissues, structure);
    for (const std::string& id : ids) looks[id] = *found->second.look;
    if (!ids.empty()) found->second.look.reset();
  }
}

Vec3 colourOfNew(const TissueSet& tissues, const std::string& name, int label) {
  for (const Tissue& tissue : tissues.tissues) {
    if (sameName(tissue.structure, name)) return tissue.colour;
  }
  for (const Tissue& tissue : tissues.tissues) {
    if (sameName(tissue.id, name) || sameName(tissue.name, name)) return tissue.colour;
  }
  return labelColour(label);
}

}  // namespace trephine
