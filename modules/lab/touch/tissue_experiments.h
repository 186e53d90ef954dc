// The experiments of tissue_measurement.h, a function each. Inside this folder.
#pragma once

#include "lab/touch/tissue_bench.h"
#include "lab/touch/tissue_measurement.h"

namespace trephine::tissue_experiments {

// What they are done on: the shipped tissues.
struct Shipped {
  TissueSet abdomen, cranium;
};
Result<Shipped> readShipped();

// The shipped numbers that lie outside of their published range, with its nearest end.
std::vector<ScaledForce> scaledNumbers(const Shipped& shipped);

// Adds its rows and curves.
Status liverPuncture(const Shipped& shipped, TissueMeasurement& out);     // A1, A2, A3, A5
Status skinToKidney(const Shipped& shipped, TissueMeasurement& out);      // A4
Status duraPuncture(const Shipped& shipped, TissueMeasurement& out);      // A6
Status brainStrokes(const Shipped& shipped, TissueMeasurement& out);      // A7
Status liverCut(const Shipped& shipped, TissueMeasurement& out);          // A8
Status burrByPush(const Shipped& shipped, TissueMeasurement& out);        // A9
Status energyOfBurr(const Shipped& shipped, TissueMeasurement& out);      // A10
Status burrThroughVault(const Shipped& shipped, TissueMeasurement& out);  // A11
Status burrHoleByHand(const Shipped& shipped, TissueMeasurement& out);    // A12

}  // namespace trephine::tissue_experiments
