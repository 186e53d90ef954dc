#include "exercise/exercise_structures.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/codes.h"
#include "base/tr.h"
#include "exercise/codes.h"

namespace trephine {

namespace {

bool isIn(const LabelMap* labels, const std::string& structure) {
  const Structure* found = labels ? labels->find(structure) : nullptr;
  if (!found) return false;
  const auto& of_voxel = labels->labels;
  return std::find(of_voxel.begin(), of_voxel.end(), std::uint8_t(found->label)) != of_voxel.end();
}

const Tissue* tissueIn(const TissueSet& set, const std::string& structure) {
  for (const Tissue& tissue : set.tissues) {
    if (!tissue.structure.empty() && sameName(tissue.structure, structure)) return &tissue;
  }
  return nullptr;
}

// The first that is needed and lacking, among those that tell a tissue.
const std::string* lacking(const Exercise& exercise, const LabelMap* labels) {
  for (const std::string& name : exercise.structures) {
    const Tissue* tissue = tissueIn(exercise.tissues, name);
    if (!tissue || isIn(labels, name)) continue;
    if (tissue->shell && isIn(labels, tissue->shell->of)) continue;
    return &name;
  }
  return nullptr;
}

}  // namespace

Result<PlacedStructures> placeStructures(const Exercise& exercise,
                                         std::shared_ptr<const LabelMap> labels) {
  PlacedStructures placed{std::move(labels), {}, {}};
  if (const std::string* name = lacking(exercise, placed.labels.get())) {
    if (!exercise.tissues_elsewhere) {
      return Error{code::kNoStructure,
                   tr("The exercise needs the structure '{}', and the case has none", *name),
                   tr("the case"), tr("Make it in the slices, or give a label map that names it")};
    }
    placed.elsewhere = true;
    placed.warnings.push_back(
        {code::kLacksStructure, tr("The case has no structure '{}': tissue is told by its HU "
                                   "alone, so that whatever has the same HU is taken for it",
                                   *name)});
  }
  for (const std::string& name : exercise.structures) {
    if (tissueIn(exercise.tissues, name) || isIn(placed.labels.get(), name)) continue;
    placed.warnings.push_back(
        {code::kLacksStructure,
         tr("The case has no structure '{}', which the exercise needs", name)});
  }
  placed.labels = withShells(placed.elsewhere ? *exercise.tissues_elsewhere : exercise.tissues,
                             std::move(placed.labels));
  return placed;
}

std::shared_ptr<const LabelMap> withShells(const TissueSet& set,
                                           std::shared_ptr<const LabelMap> labels) {
  std::optional<LabelMap> with;
  for (const Tissue& tissue : set.tissues) {
    if (!tissue.shell || isIn(labels.get(), tissue.structure) ||
        !isIn(labels.get(), tissue.shell->of)) {
      continue;
    }
    if (!with) with = *labels;
    const int label = unusedLabel(*with);
    if (label == 0) continue;
    const auto shell =
        shellOf(*with, with->find(tissue.shell->of)->label, tissue.shell->thickness_mm);
    for (std::size_t i = 0; i < shell.size(); ++i) {
      if (shell[i]) with->labels[i] = std::uint8_t(label);
    }
    std::erase_if(with->structures,
                  [&](const auto& s) { return sameName(s.name, tissue.structure); });
    with->structures.push_back({label, tissue.structure, tissue.colour, tissue.id});
  }
  return with ? std::make_shared<const LabelMap>(*std::move(with)) : labels;
}

void placeTissues(TissueSet& set, const LabelMap* labels) {
  const int nowhere = labels ? unusedLabel(*labels) : 255;
  for (Tissue& tissue : set.tissues) {
    if (tissue.structure.empty()) continue;
    const Structure* found = labels ? labels->find(tissue.structure) : nullptr;
    tissue.label = found ? found->label : nowhere;
  }
}

}  // namespace trephine
