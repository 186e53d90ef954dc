// A scene's tissues in the structures of a case: names become the case's numbers.
#pragma once

#include <memory>
#include <vector>

#include "base/result.h"
#include "scene/scene.h"
#include "volume/label_map.h"

namespace trephine {

struct PlacedStructures {
  // The case's, with the shells that tissues ask for where it has none of that name; null: none.
  std::shared_ptr<const LabelMap> labels;
  std::vector<Warning> warnings;  // LACKS_STRUCTURE
};

// Gives each tissue of `scene` that names a structure the label which it has in `labels` (fitted to
// the CT; null: none), or one that no voxel has. Where the case lacks a structure that the scene
// needs, the tissues for elsewhere take their place, known by HU. The same whether or not it was
// done before, but for those. Error: NO_STRUCTURE where one is needed, a tissue is known by it
// alone and there are no tissues for elsewhere.
Result<PlacedStructures> placeStructures(Scene& scene, std::shared_ptr<const LabelMap> labels);

// The case's labels with the shells that tissues ask for where it has none of that name, each with
// the lowest label that is free: so always the same for the same case.
std::shared_ptr<const LabelMap> withShells(const TissueSet& tissues,
                                           std::shared_ptr<const LabelMap> labels);

// The labels alone, of a set that was edited: those that placeStructures() has found.
void placeTissues(TissueSet& tissues, const LabelMap* labels);

// The tissues as a file has them: without the labels of a case where they name a structure.
TissueSet unplaced(TissueSet tissues);

}  // namespace trephine
