// A direction in the plane that turns by the golden angle each step: what spreads points evenly over
// a round surface (Fibonacci lattice). By multiplication alone, so that every machine gets the same
// bits and replays them.
#pragma once

namespace trephine {

struct GoldenTurn {
  double cosine = 1.0, sine = 0.0;

  void next() {
    constexpr double kCosine = -0.73736887807832, kSine = 0.67549029426152;
    const double c = cosine * kCosine - sine * kSine;
    sine = cosine * kSine + sine * kCosine;
    cosine = c;
  }
};

}  // namespace trephine
