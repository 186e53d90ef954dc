// The CT that a case was read from, as its files name it: for a segmentation that refers to it.
#pragma once

#include <filesystem>

#include "base/progress.h"
#include "base/result.h"
#include "imaging/dicom/seg_writer.h"
#include "imaging/report/report.h"

namespace trephine {

// Finds the series in a DICOM folder or file again and takes the UIDs of the slices that the case
// was made of. Whoever has them knows the patient where the CT is kept: they go into one file that
// was asked for, and nowhere else. `of` is the case's provenance, `on` its grid.
// Errors: BAD_SOURCE (no DICOM, another CT, or one that is emptied of UIDs), those of a scan
// (MISSING_FOLDER, CANCELLED, SOURCE_VANISHED, OUT_OF_MEMORY). Any thread.
Result<RawSourceUids> sourceUids(const std::filesystem::path& source, const Provenance& of,
                                 const GridGeometry& on, const Progress& progress = Progress());

}  // namespace trephine
