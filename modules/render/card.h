// A card that stands in the scene to be read, in a picture that has no panel around it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/math.h"

namespace trephine {

// It is read from the side from which the pose looks along -z, upright along y.
struct Card {
  std::string name;  // which card it is, from one time to the next
  Pose pose_mm;      // of its middle, patient frame
  double width_mm = 0.0;
  bool before_all = false;         // tissue does not hide it
  int width = 0, height = 0;       // pixels
  std::vector<std::uint8_t> rgba;  // rows go down; colours are not multiplied by alpha
};

}  // namespace trephine
