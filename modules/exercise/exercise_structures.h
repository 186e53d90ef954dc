// An exercise's tissues in the structures of a case: names become the case's numbers.
#pragma once

#include <memory>
#include <vector>

#include "base/result.h"
#include "exercise/exercise.h"
#include "volume/label_map.h"

namespace trephine {

struct PlacedStructures {
  // The case's, with the shells that tissues ask for where it has none of that name; null: none.
  std::shared_ptr<const LabelMap> labels;
  bool elsewhere = false;         // the exercise's tissues for elsewhere are in force
  std::vector<Warning> warnings;  // LACKS_STRUCTURE
};

// What the tissues of `exercise` find in `labels` (fitted to the CT; null: none). Where the case
// lacks a structure that the exercise needs, the tissues for elsewhere take their place, known by
// HU. Error: NO_STRUCTURE where one is needed, a tissue is known by it alone and there are no
// tissues for elsewhere. Pure.
Result<PlacedStructures> placeStructures(const Exercise& exercise,
                                         std::shared_ptr<const LabelMap> labels);

// The case's labels with the shells that tissues ask for where it has none of that name, each with
// the lowest label that is free: so always the same for the same case.
std::shared_ptr<const LabelMap> withShells(const TissueSet& tissues,
                                           std::shared_ptr<const LabelMap> labels);

// Gives each tissue that names a structure the label which it has in `labels`, those that
// placeStructures() has found, or one that no voxel has.
void placeTissues(TissueSet& tissues, const LabelMap* labels);

}  // namespace trephine
