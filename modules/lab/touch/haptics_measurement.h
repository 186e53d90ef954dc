// What does a tick of touch cost, and how true is the push of elastic tissue?
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "lab/touch/sliding_measurement.h"
#include "volume/grid.h"

namespace trephine {

enum class TouchPhase { free, contact, removal };
const char* touchPhaseName(TouchPhase phase);

// The time of one HapticCore::tick of all arms [ns]: every tick of the phase free, else those with
// a tool in tissue or a voxel taken.
struct HapticsRow {
  std::string tool;  // needle, blade64, burr6
  int arms = 1;
  int grid = 256;  // voxels along each edge
  double box_mm = 200.0;
  TouchPhase phase = TouchPhase::free;
  double mean_ns = 0.0, median_ns = 0.0, p99_ns = 0.0, p999_ns = 0.0, max_ns = 0.0;
  double removed_mm3_per_s = 0.0;  // by all arms, over the ticks that count
  std::size_t ticks = 0;           // that count
  std::size_t touched = 0;         // with a tool in tissue
  std::size_t ran = 0;
};
// Nothing touched while free, always while in contact, something taken in removal.
bool isOfItsPhase(const HapticsRow& row);

// Every tool moves over the top of one shell of bone, the same way in every grid, at 10 to 20 mm/s:
// the laws viscous, coulomb and elastic over all its points, `bounded`, removal by work.
struct HapticsOptions {
  int ticks = 12'000;                         // a row, 100 to 1,000,000, at 1 kHz
  std::vector<int> grids{256, 512};           // 32 to 1024
  std::vector<double> boxes_mm{200.0, 49.2};  // 49.2 to 300: smaller would not hold the strokes
  SlidingOptions sliding;
};

struct HapticsMeasurement {
  std::vector<HapticsRow> rows;
  SlidingMeasurement sliding;
};

// Runs one row (its tool, arms and phase) in a grid over the top of the shell, which is as before
// afterwards. Errors: CANCELLED, CANNOT_WRITE (the journal is kept in `journal_folder`).
Result<HapticsRow> measureHapticsRow(HapticsRow row, Grid& grid, int ticks,
                                     const std::filesystem::path& journal_folder,
                                     const Progress& progress = Progress());

// From the times of the ticks that count.
HapticsRow summarizeTicks(std::vector<double> ns, HapticsRow row);

// One thing asked for. `pass` is value <= limit.
struct HapticsBar {
  std::string name;
  double value = 0.0;
  double limit = 0.0;
  bool pass() const { return value <= limit; }
};
// Those whose rows were measured, the sliding ones always.
std::vector<HapticsBar> hapticsBars(const HapticsMeasurement& measurement);

// Writes haptics.csv into the folder `out` unless that is empty. Holds the grids of one box at a
// time. Errors: BAD_ARGUMENT, CANCELLED, CANNOT_WRITE.
Result<HapticsMeasurement> measureHaptics(const HapticsOptions& options,
                                          const std::filesystem::path& out = {},
                                          const Progress& progress = Progress());

// {rows:[{tool, arms, grid, box_mm, phase, ns:{mean, median, p99, p999, max}, removed_mm3_per_s,
// ticks}],
//  direction_error_deg:{median, p99}, sliding_force_step_percent_p99, depth_error_percent,
//  bars:[{name, value, limit, pass}]}
Json toJson(const HapticsMeasurement& measurement);
std::string toText(const HapticsMeasurement& measurement);

}  // namespace trephine
