// One eye of a picture for two: where it is and what it sees. It looks along -z of its pose, with x
// to the right and y up. The unit of a pose's position stands in the name of the variable.
#pragma once

#include <array>

#include "base/math.h"

namespace trephine {

// Tangents of the angles between the axis and the picture's edges; left and down are negative where
// the axis runs through the picture.
struct FieldOfView {
  double left = -1.0, right = 1.0, down = -1.0, up = 1.0;
  friend bool operator==(const FieldOfView&, const FieldOfView&) = default;
};

struct EyeView {
  Pose pose;
  FieldOfView sees;
};
using Eyes = std::array<EyeView, 2>;  // left, right

}  // namespace trephine
