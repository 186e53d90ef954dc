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

// How far [mm] a tool that comes out of a place along `outward` is in tissue, any of the set: to
// the first kClear_mm without. 0 at a surface and in air; at most kDeepest_mm. Pure.
constexpr double kClear_mm = 5.0, kDeepest_mm = 150.0;
double depthInTissue_mm(const Volume& volume, const TissueSet& tissues, const LabelMap* labels,
                        const Vec3& at_mm, const Vec3& outward);

// The exercise's landmark at that place instead.
Landmark placedAt(const Landmark& landmark, const Vec3& at_mm, const Vec3& outward);

}  // namespace trephine
