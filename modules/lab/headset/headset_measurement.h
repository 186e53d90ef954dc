// What a picture for two eyes costs, and what it costs others: the panel beside it, the haptic
// thread; whether it is where theory puts it; and whether anything stays behind when a headset is
// switched, lost, or its software hangs or fails.
//
// With the test runtime (headset/test_runtime.h) unless XR_RUNTIME_JSON names another: then nothing
// can be lost on purpose, and those figures are null.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "machine/common/spread.h"

namespace trephine {

struct HeadsetMeasureOptions {
  double seconds = 20.0;  // of the exercise with a headset, and as long without; 2 to 600
  int toggles = 50;       // 0 to 1000
  int losses = 20;        // of each of five kinds, 0 to 1000
  bool pictures = true;   // of both eyes, for each shipped exercise
};

struct HeadsetRow {
  std::string kind;           // "openxr", "side-by-side"
  int width = 0, height = 0;  // of an eye's picture
  Spread eyes_ms;             // both, one after the other
  // From the eyes' place to the frame that shows the picture drawn for it.
  Spread pose_age_ms;
  double pairs_hz = 0.0;
  double repeats_percent = 0.0;  // frames with the pair of the frame before, once
  double held_percent = 0.0;     // with one that stands in the room, until there is another
};

struct HeadsetMeasurement {
  std::string opengl;
  bool real_runtime = false;
  std::vector<HeadsetRow> rows;
  // Worst of places outside and inside of a volume's box.
  double disparity_error_px = 0.0, vertical_error_px = 0.0, psnr_to_crop_db = 0.0;
  int toggles = 0;            // of which each showed pictures, and ended when asked
  std::optional<int> losses;  // that ended as they should
  std::optional<int> failures, failures_ended;  // calls that failed on purpose
  int leaked_textures = 0, leaked_fds = 0, leaked_threads = 0;
  Spread cleaned_ms;  // from a loss, or the return of a call that hung, to the end
  double gap_ms = 0.0, gap_lost_ms = 0.0;  // longest turn of the panel's loop
  double gap_without_ms = 0.0;             // the same without a headset
  double missed_with_percent = 0.0, missed_without_percent = 0.0;
  int late_with = 0, late_without = 0;  // times that lateness took the force away
  bool recording_replays = false;       // of the exercise that went on all the time
  std::vector<std::string> violations;  // of OpenXR's rules, as the test runtime saw them
};

// Errors: BAD_OPTION, NO_DISPLAY, NO_OPENGL, NO_LOADER, NO_RUNTIME, those of a headset that cannot
// be had, of the exercise and of files, CANCELLED.
Result<HeadsetMeasurement> measureHeadset(const HeadsetMeasureOptions& options,
                                          const std::filesystem::path& out,
                                          const Progress& progress = Progress());
Json toJson(const HeadsetMeasurement& measured);
std::string toText(const HeadsetMeasurement& measured);

}  // namespace trephine
