// The rows of `trephine-measure extremes` that run in extremes_rig.h: what they share, and their
// groups, each a file with its functions beside its table.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/formatted.h"
#include "lab/touch/extremes_rig.h"

namespace trephine::extremes {

struct Outcome {
  std::string got;
  bool pass = false;
};

// As in ExtremeRow; `measure` runs it.
struct Case {
  const char* name;
  const char* input;
  const char* expected;
  std::function<Outcome()> measure;
};

std::vector<Case> motionCases();     // how fast, and against how much
std::vector<Case> clockCases();      // when
std::vector<Case> notFiniteCases();  // numbers that are none
std::vector<Case> shapeCases();      // HU, grids and tools
std::vector<Case> endureCases();     // a long session; a device that goes

constexpr int kClear = 300;      // the tick in which a row clears its faults
constexpr double kFelt_N = 0.1;  // the stroke in bone gives more than this

inline const char* const kStroke = "above 0.1 N, 11 voxels cut (2 more or less), no fault";
inline const char* const kAsUsual = "the reference's force in every tick, no fault";
inline const char* const kFaultInMiddle =
    "a fault from tick 200 until it is cleared, no force meanwhile, force and cutting after it";

// The stroke with `change` made to its samples from tick `from` to before `to`.
auto strokeWith(auto change, int from = 0, int to = kTicks) {
  return [=](int tick) {
    Sample sample = stroke(tick);
    if (tick >= from && tick < to) change(sample);
    return sample;
  };
}

const TimedCommand kClearFaults{kClear, {CommandKind::clear_faults, 0, {}}};

// The voxels that stroke() passes at this spacing.
int voxelsOnTheWay(double spacing_mm);

// `as_expected`, unless the run broke what no run may.
Outcome judge(const Run& run, bool as_expected, const std::string& got);
// Force is felt, this many voxels are cut (2 more or less), nothing faults.
Outcome ordinary(const Setup& setup, int voxels);
Outcome nothingTouched(const Setup& setup);
// The same tick by tick as without the extreme.
Outcome undisturbed(const Setup& setup);
// A fault in `tick` that stands until it is cleared, and work as before after it.
Outcome faultThenWork(const Setup& setup, std::uint32_t fault, int tick);

}  // namespace trephine::extremes
