// Writes a volume as a CT series: one explicit little-endian file a slice, for phantoms and tests.
#pragma once

#include <filesystem>

#include "base/progress.h"
#include "base/result.h"
#include "volume/volume.h"

namespace trephine {

struct CtSeriesText {
  std::string series_description;
  std::string body_part;
};

// Makes `folder` and writes IM0001.dcm onwards, in increasing k. The patient is named
// "TREPHINE^PHANTOM"; UIDs are derived from the volume's sha256, so that equal volumes give equal
// files. Rescale slope 1, intercept -1024 with unsigned 16-bit pixels where the HU allow, else
// intercept 0 with signed ones. Errors: CANNOT_WRITE (nothing half-written is left), CANCELLED.
Status writeCtSeries(const Volume& volume, const CtSeriesText& text,
                     const std::filesystem::path& folder, const Progress& progress = Progress());

}  // namespace trephine
