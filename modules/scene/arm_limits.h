// What the arms of a scene can show of a tissue's numbers.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "scene/scene.h"
#include "tissue/tissue_numbers.h"

namespace trephine {

// Of the weakest of the arms, in the tissue's own numbers.
struct ArmsLimit {
  Renderable most;
  double force_N = 0.0;  // that a tissue may push with
};
// None where the dynamics of no arm are known.
std::optional<ArmsLimit> armsLimit(const Scene& scene);

// Whether one of these laws uses the number; work that removes counts under any.
bool isFelt(const TissueNumber& number, const std::vector<LawKind>& laws);

// The most of this number that such arms show while the tissue's others stay as they are: of
// impedances what `demanded` of the whole tissue leaves, of forces the limit of the arms as well.
// None where no law uses the number, or where an arm has no say in it, as in the energy of cutting.
using DemandedOf = std::function<Impedance(const Tissue&)>;
std::optional<double> mostShown(const TissueNumber& number, const Tissue& tissue,
                                const ArmsLimit& arms, const DemandedOf& demanded);

}  // namespace trephine
