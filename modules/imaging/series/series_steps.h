// How the slices of a stack follow one another along its normal: even steps, jittered and rounded
// ones, gaps. Pure.
#pragma once

#include <cstddef>
#include <vector>

#include "imaging/series/series_geometry.h"

namespace trephine {

struct Slice {
  std::size_t input;
  double place_mm;
  bool usable;
};

using Slices = std::vector<Slice>;

// Sets the slices of the volume and its spacing along k, with what is found and asked on the way.
// `slices` in increasing place, no two at one.
void planAlongNormal(Slices slices, const StackInput& input, const Vec3& normal,
                     const Answers& answers, Stack& stack);

}  // namespace trephine
