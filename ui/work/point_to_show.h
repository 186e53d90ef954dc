// Where the slices of a case are opened. Pure.
#pragma once

#include <optional>

#include "case/placement.h"

namespace trephine {

// A place of the patient, LPS, mm: where the exercise enters, if a person has put that there; in
// the middle of the structure that it needs first, where the case has one; else at the landmark
// that it looks at; none without either. Where a slice through a landmark would graze the patient,
// the place is moved along that axis of the grid to the nearest slice that shows a third of what
// the fullest does.
std::optional<Vec3> pointToShow(const Placement& placed,
                                const std::optional<LandmarkFrame>& landmark);

}  // namespace trephine
