// Where an exercise enters the patient, when a person clicks instead of a ray in a file.
#pragma once

#include <optional>

#include "exercise/exercise.h"

namespace trephine {

// The landmark that an exercise enters at: the one it is looked at from, else the first arm's; null
// where all is fixed in the patient.
const Landmark* entryLandmark(const Exercise& exercise);

// The direction out of the patient at a place: away from the body where air is within
// kEntryBall_mm, else away from the landmark's tissue where that ends there; else nothing, deep
// inside of either. The mean direction to the ball's voxels that are of it, turned round. `tissue`:
// an id of the set; `labels` are fitted to the volume, null for none. Pure; a ball of voxels.
constexpr double kEntryBall_mm = 8.0;
std::optional<Vec3> outwardAt(const Volume& volume, const TissueSet& tissues,
                              const LabelMap* labels, const std::string& tissue, const Vec3& at_mm);

// The exercise's landmark at that place instead.
Landmark placedAt(const Landmark& landmark, const Vec3& at_mm, const Vec3& outward);

}  // namespace trephine
