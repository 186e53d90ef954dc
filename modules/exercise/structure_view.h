// How the 3-D view shows the structures of a case. One that a tissue of the exercise is of looks as
// that tissue does; every other gets a tissue of its own, for the picture alone. What is felt, cut,
// recorded and saved knows nothing of it. Pure.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tissue/tissue_look.h"
#include "tissue/tissue_set.h"
#include "volume/label_map.h"

namespace trephine {

// What a person has chosen of a structure.
struct StructureLook {
  std::optional<TissueLook> look{};  // absent: shown
  std::optional<double> opacity{};   // per mm; absent: its tissue's, else kSeenOpacity
  std::optional<Vec3> colour{};      // that a person gave it; absent: its tissue's, else its own
  friend bool operator==(const StructureLook&, const StructureLook&) = default;
};
using StructureLooks = std::map<int, StructureLook>;  // by label

struct SeenStructure {
  int label = 0;
  TissueLook look = TissueLook::shown;
  double opacity = kSeenOpacity;  // [0, 1] per mm
  // False: a picture tells kMaxTissues tissues apart and these are taken; it shows the structure by
  // its HU.
  bool has_room = true;
  // Whether a person can choose its look: a hidden one may get room by being shown.
  bool takesLook() const { return has_room || look == TissueLook::hidden; }
  friend bool operator==(const SeenStructure&, const SeenStructure&) = default;
};

struct SeenTissues {
  TissueSet tissues;  // the exercise's in their order, then those of the picture alone
  TissueLooks looks;
  std::vector<SeenStructure> structures;  // as they were given
};

// `structures` are rows of the label map that is shown. Those that are not hidden have room first,
// in their order, the one with the label `first` before all (0: none).
SeenTissues withStructures(const TissueSet& tissues, const TissueLooks& looks,
                           const std::vector<Structure>& structures, const StructureLooks& chosen,
                           int first = 0);

// The tissues of the set that are of this structure, by its name or its label.
std::vector<std::string> tissuesOf(const TissueSet& tissues, const Structure& structure);

// A look that was chosen of a structure which a tissue is of becomes the look of that tissue, and
// is absent in `chosen` then; opacity and colour stay there and go before the tissue's. It is
// called before withStructures(), which takes the look of such structures from `looks` alone.
void handToTissues(StructureLooks& chosen, TissueLooks& looks, const TissueSet& tissues,
                   const std::vector<Structure>& structures);

// Of a new structure: that of the tissue which is of it, or is called so; else one to tell labels
// apart.
Vec3 colourOfNew(const TissueSet& tissues, const std::string& name, int label);

}  // namespace trephine
