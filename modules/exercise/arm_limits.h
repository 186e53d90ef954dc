// What the arms of an exercise can show of a tissue's numbers.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "exercise/exercise.h"
#include "tissue/tissue_numbers.h"

namespace trephine {

// The most that is sent to an arm: what the exercise allows, and the device, where that was asked.
double mostForce_N(const ExerciseArm& arm, const std::optional<ArmDynamics>& dynamics);

// Of the weakest of the arms, in the tissue's own numbers.
struct ArmsLimit {
  Renderable most;
  double force_N = 0.0;  // that a tissue may push with
};
// None where the dynamics of no arm are known.
std::optional<ArmsLimit> armsLimit(const Exercise& exercise, const Rig& rig);

// Newtons, which are clamped under every controller.
bool isForce(const TissueNumber& number);

// Whether the exercise has a use for the number in this tissue: a law that uses it, and whatever
// else of the tissue that law needs; of what cutting costs, removal by work of a tissue that can be
// cut.
bool isFelt(const TissueNumber& number, const Tissue& tissue, const std::vector<LawKind>& laws,
            RemovalKind removal);

// The most of this number that such arms show while the tissue's others stay as they are. Damping
// and stiffness are bounded each by itself: of either what `demanded` of the whole tissue leaves;
// of forces the limit of the arms. None where no law uses the number, or where an arm has no say in
// it, as in the energy of cutting.
using DemandedOf = std::function<Impedance(const Tissue&)>;
std::optional<double> mostShown(const TissueNumber& number, const Tissue& tissue,
                                const ArmsLimit& arms, const DemandedOf& demanded);

// Whether a force comes weaker than it says, under `bounded`: what pushes with it is a spring that
// is softer in the hand than the tissue's.
bool isWeaker(const TissueNumber& number, const Tissue& tissue, const ArmsLimit& arms,
              const DemandedOf& demanded);

}  // namespace trephine
