#include "tissue/tissue_look.h"

#include <algorithm>

namespace trephine {

namespace {

// What a tissue is to a preset, by its id in a set.
enum class Part { bone, skin, liver, capsule, liver_vessel, other };
constexpr std::array<std::pair<std::string_view, Part>, 7> kParts{
    {{"bone", Part::bone},
     {"skin", Part::skin},
     {"scalp", Part::skin},
     {"liver", Part::liver},
     {"capsule", Part::capsule},
     {"vessel", Part::liver_vessel},
     {"gallbladder", Part::liver_vessel}}};

Part partOf(const Tissue& tissue) {
  for (const auto& [id, part] : kParts) {
    if (id == tissue.id) return part;
  }
  return Part::other;
}

// Whether a preset is about this tissue: without one such it is not offered.
bool isAbout(ViewPreset preset, const Tissue& tissue) {
  const Part part = partOf(tissue);
  switch (preset) {
    case ViewPreset::bone:
      return part == Part::bone;
    case ViewPreset::skin:
      return part == Part::skin;
    case ViewPreset::soft_tissue:
      return part != Part::bone && tissue.opacity > 0.0;
    case ViewPreset::liver:
      return part == Part::liver;
  }
  return false;
}

TissueLook lookIn(ViewPreset preset, const Tissue& tissue) {
  const Part part = partOf(tissue);
  const TissueLook own = lookOf(tissue, {});
  switch (preset) {
    case ViewPreset::bone:
      return part == Part::bone ? TissueLook::shown : TissueLook::hidden;
    case ViewPreset::skin:
      return part == Part::skin ? TissueLook::shown : own;
    case ViewPreset::soft_tissue:
      return part == Part::bone ? TissueLook::ghosted : own;
    case ViewPreset::liver:
      if (part == Part::bone) return TissueLook::ghosted;
      // By HU alone a capsule is the rim of much else.
      if (part == Part::capsule && !tissue.isAnywhere()) return TissueLook::shown;
      return part == Part::liver || part == Part::liver_vessel ? TissueLook::shown
                                                               : TissueLook::hidden;
  }
  return own;
}

}  // namespace

TissueLook lookOf(const Tissue& tissue, const TissueLooks& looks) {
  const auto named = looks.find(tissue.id);
  if (named != looks.end()) return named->second;
  return tissue.opacity > 0.0 ? TissueLook::shown : TissueLook::hidden;
}

TissueSet asSeen(TissueSet tissues, const TissueLooks& looks) {
  for (Tissue& tissue : tissues.tissues) {
    if (lookOf(tissue, looks) == TissueLook::hidden) {
      tissue.opacity = 0.0;
    } else if (tissue.opacity == 0.0) {
      tissue.opacity = kSeenOpacity;
    }
  }
  return tissues;
}

std::optional<TissueLooks> presetLooks(const TissueSet& set, ViewPreset preset) {
  if (std::none_of(set.tissues.begin(), set.tissues.end(),
                   [&](const Tissue& tissue) { return isAbout(preset, tissue); })) {
    return std::nullopt;
  }
  TissueLooks looks;
  for (const Tissue& tissue : set.tissues) looks[tissue.id] = lookIn(preset, tissue);
  return looks;
}

}  // namespace trephine
