// A scripted exercise in the real window, and what it cost.
#pragma once

#include <filesystem>
#include <optional>

#include "base/json.h"
#include "base/progress.h"
#include "exercise/policy.h"
#include "session/run_report.h"
#include "ui/common/stall_meter.h"

namespace trephine {

struct ExerciseOptions {
  std::filesystem::path exercise;
  std::filesystem::path arms{};   // a file (exercise/arms_file.h); empty: the exercise's own devices
  std::optional<double> seconds;  // absent: as long as the exercise's script
  std::filesystem::path out;      // recording and picture go there
  Policy policy{};                // what the workstation locks
};

struct ExerciseOutcome {
  RunReport report;
  double start_ms = 0.0;  // from the start of the process to the first picture of the volume
  double session_ms = 0.0;  // to the exercise's first tick, within some ms
  int frames = 0;         // painted while the exercise ran, and how long each took
  double frame_median_ms = 0.0, frame_p99_ms = 0.0;
  Stall longest_stall;            // of the window's event loop while the exercise ran
  std::optional<Error> failure;   // the recording's, or CANCELLED; the rest holds all the same
};

// Needs a TimedApplication (of another QApplication the stalls are not known); runs its event
// loop. Opens the exercise's case in a window, plays its default
// script in real time, and takes a picture at the end. A recording that fails ends nothing: nobody
// is there to be asked. The Error is what the window would have said of an exercise that did not
// run.
Result<ExerciseOutcome> runExercise(const ExerciseOptions& options,
                                    const Progress& progress = Progress());

Json toJson(const ExerciseOutcome& outcome);
std::string toText(const ExerciseOutcome& outcome);

// The value below which a `share` of them lies (nearest rank); 0 of none.
double percentile(std::vector<double> values, double share);

}  // namespace trephine
