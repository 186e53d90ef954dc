// What is done to a volume once its voxels are there: couch, face, crop, resolution, thick
// slices.
#pragma once

#include <optional>

#include "base/progress.h"
#include "base/result.h"
#include "imaging/report/report.h"

namespace trephine {

// Looks for couch, face and thick slices, offers them as choices in `series`, and does what
// `request` asks, in this order: couch, face, crop, reduction, slices between the slices. Takes the
// HU range anew where voxels changed. Errors: BAD_CROP, BAD_REDUCTION, OUT_OF_MEMORY, CANCELLED;
// FACE_TAKES_MORE and FACE_REMAINS, where a face was to be cut away: the series is refused then,
// and asks.
Status takeVolumeSteps(const ImportRequest& request, const Progress& progress, SeriesReport& series,
                       Volume& volume, std::optional<MeasuredLoss>& loss);

}  // namespace trephine
