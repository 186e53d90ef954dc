// How a view shows a tissue. It changes neither what is felt nor what is cut nor what is recorded.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "tissue/tissue_set.h"

namespace trephine {

enum class TissueLook : std::uint8_t {
  shown,    // in its colour, with its opacity
  ghosted,  // its outline alone, so that what lies behind it is seen
  hidden
};

// In files.
inline constexpr std::array<std::pair<std::string_view, TissueLook>, 3> kTissueLookNames{
    {{"shown", TissueLook::shown},
     {"ghosted", TissueLook::ghosted},
     {"hidden", TissueLook::hidden}}};

// By id. What is not named here looks as its set says: shown, or hidden where its opacity is 0.
using TissueLooks = std::map<std::string, TissueLook>;
TissueLook lookOf(const Tissue& tissue, const TissueLooks& looks);

// Opacity [0, 1] per mm of a tissue that looks show or ghost and whose own opacity is 0: enough to
// see its surface.
constexpr double kSeenOpacity = 0.9;

// The set with the opacities that these looks leave: 0 where hidden, at least kSeenOpacity instead
// of 0 where not. A ghost keeps its opacity: the renderer is told the looks as well, and calls this
// itself.
TissueSet asSeen(TissueSet tissues, const TissueLooks& looks);

// Looks to start from, for the tissues of a set.
enum class ViewPreset : std::uint8_t { bone, skin, soft_tissue, liver };
inline constexpr std::array kViewPresets{ViewPreset::bone, ViewPreset::skin,
                                         ViewPreset::soft_tissue, ViewPreset::liver};

// A look for every tissue of the set:
// - bone: bone alone;
// - skin: skin, and behind it what the set shows;
// - soft tissue: what the set shows, through a ghost of the bone;
// - liver: the liver with its vessels, through a ghost of the bone.
// Nothing where the set lacks what the preset is about: bone; skin or scalp; a visible tissue other
// than bone; liver. Tissues are known by these ids and by capsule, vessel and gallbladder (of the
// liver); any other is "other".
std::optional<TissueLooks> presetLooks(const TissueSet& tissues, ViewPreset preset);

}  // namespace trephine
