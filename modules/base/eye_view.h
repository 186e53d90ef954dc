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

// Between both eyes, and where they look on average: displays of both may be turned outwards.
struct Head {
  Vec3 position{0.0};
  Vec3 forward{0.0, 0.0, -1.0}, up{0.0, 1.0, 0.0};  // of length 1
};
inline Head headOf(const Eyes& eyes) {
  const Pose &left = eyes[0].pose, &right = eyes[1].pose;
  const auto both = [&](const Vec3& axis) {
    const Vec3 sum = left.orientation * axis + right.orientation * axis;
    return glm::length(sum) > 0.0 ? glm::normalize(sum) : left.orientation * axis;
  };
  return {0.5 * (left.position + right.position), both(Vec3(0.0, 0.0, -1.0)),
          both(Vec3(0.0, 1.0, 0.0))};
}

}  // namespace trephine
