// Headers -> series, each with its verdict so far. Pure: no file is opened but to compare two that
// claim to be the same image.
#pragma once

#include <optional>
#include <vector>

#include "imaging/dicom_file.h"
#include "imaging/importer.h"

namespace trephine {

struct Series {
  SeriesReport report;
  // In increasing place along the stack's k axis unless the series is refused.
  std::vector<DicomHeader> slices;
};

// Groups by Study and Series UID and splits what cannot be one stack: different size, spacing,
// orientation, photometric interpretation, samples, frame of reference, kind, or a localizer.
// `headers` are sorted by SOP Instance UID; the result does not depend on names or order of files.
std::vector<Series> groupSeries(std::vector<DicomHeader> headers);

// Fills one series' report: every finding that headers can give, geometry and verdict; orders its
// slices. (series_checks.cpp)
void assessSeries(Series& series);

// The worst of the findings' severities.
Verdict verdictOf(const std::vector<Finding>& findings);

// "slice 12", by instance number, or "a slice without number".
std::string sliceName(const DicomHeader& header);

// CT of which a volume could come: images of the CT storage classes.
bool isCt(const DicomHeader& header);
// ImageType says LOCALIZER.
bool isLocalizer(const DicomHeader& header);

}  // namespace trephine
