// Where a hand that nobody's script moves begins: outside of tissue.
#pragma once

#include <vector>

#include "haptics/haptic_core.h"

namespace trephine {

// How far [mm, patient] each arm's tool is drawn back along its own axis from where the arm's
// origin puts it, until no point of it is in tissue, with a few mm to spare. 0 for a tool that is
// in air there, and for one that is in tissue everywhere within `reach_mm` of its arm. A free place
// farther out goes before one between two tissues.
std::vector<double> drawnBack_mm(const HapticParameters& parameters, const Grid& grid,
                                 const std::vector<double>& reach_mm);

}  // namespace trephine
