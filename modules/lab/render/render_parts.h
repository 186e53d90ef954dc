// The parts of `trephine-measure render` beside those of machine/drawing: what sets the ray caster
// beside VTK's own. Each ends with CANCELLED where it is told.
#pragma once

#include <filesystem>
#include <vector>

#include "base/codes.h"
#include "base/progress.h"
#include "base/result.h"
#include "lab/render/render_measurement.h"
#include "machine/drawing/drawing_parts.h"

namespace trephine {

inline Error renderCancelled() {
  return {code::kCancelled, "The measurement was cancelled", "measure render", ""};
}

// Still rows of a subject: sample distances by both mappers, levels by ours. Pictures go to `out`.
Status measureStills(const RenderSubject& subject, const RenderOptions& options,
                     const std::filesystem::path& out, const Progress& progress,
                     RenderMeasurement& result);
// The first picture of a series that was imported.
Status measureFirstPicture(const RenderOptions& options, const std::filesystem::path& out,
                           const Progress& progress, RenderMeasurement& result);

}  // namespace trephine
