// How the slices of a stack follow one another along its normal: even steps, jittered and rounded
// ones, gaps. Pure.
#pragma once

#include <cstddef>
#include <vector>

#include "imaging/series/detail/series_geometry.h"

namespace trephine {

struct Slice {
  std::size_t input;
  double place_mm;
  bool usable;
};

using Slices = std::vector<Slice>;

// Positions that were rounded so far that some fell together, put back on the line of their step,
// which must be known; in the order in which they were scanned. Nothing, and none is moved, where
// no such line explains them.
std::optional<Finding> takeApart(std::vector<Vec3>& positions_mm, const Vec3& normal,
                                 double step_mm);

// Sets the slices of the volume and its spacing along k, with what is found and asked on the way.
// `slices` in increasing place, no two at one.
void planAlongNormal(Slices slices, const StackInput& input, const Vec3& normal,
                     const Answers& answers, Stack& stack);

}  // namespace trephine
