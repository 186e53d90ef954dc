// How much dearer is it to send the whole volume to the GPU than the box that was cut?
#pragma once

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"

namespace trephine {

// A 48^3 dirty box on a 512x512x300 grid, medians of several tries in this run, and whether the
// picture after the box upload equals the one after a full upload. Errors: NO_DISPLAY, NO_OPENGL.
struct UploadMeasurement {
  double full_ms = 0.0;
  double box_ms = 0.0;
  double ratio = 0.0;  // full_ms / box_ms
  bool pictures_equal = false;
};
Result<UploadMeasurement> measureUpload(const Progress& progress = Progress());
Json toJson(const UploadMeasurement& measurement);  // {full_ms, box_ms, ratio, pictures_equal}

}  // namespace trephine
