// Headers -> series, and what each comes to under given answers.
#pragma once

#include <optional>
#include <vector>

#include "base/progress.h"
#include "imaging/dicom/detail/dicom_file.h"
#include "imaging/report/report.h"
#include "imaging/series/detail/series_geometry.h"

namespace trephine {

struct Series {
  SeriesReport report;            // of the last assessment; grouping's own findings come first
  std::size_t findings_kept = 0;  // how many those are
  std::vector<std::string>
      parted_by;  // what its parts (DicomHeader::part) differ in; empty: it is one
  std::vector<DicomHeader> slices;  // in increasing place along the stack's k axis
};

// How a series becomes a volume. `sources` index Series::slices, in the order of `stack.order`.
struct SeriesPlan {
  Stack stack;
  std::vector<std::size_t> sources;
  bool whole_words = false;  // all 16 bits are the value, whatever headers say (HIGH_BITS)
};

// Groups by Series UID and splits what cannot be one stack: another patient, modality, size,
// spacing, orientation, photometric interpretation, samples or kind, or a localizer. What a writer
// may have made differ within one scan (study, frame of reference, the last digits of spacing and
// orientation) makes parts of one series, which are joined on consent.
// `headers` are sorted by SOP Instance UID; the result does not depend on names or order of files.
// Files are opened only to compare those that claim to be the same image or lie at one place; once
// `progress` is cancelled, none any more.
std::vector<Series> groupSeries(std::vector<DicomHeader> headers, const Progress& progress);

// Fills the report anew: every finding that headers can give under these answers, choices, geometry
// and verdict; orders the slices. Pure. (series_checks.cpp)
SeriesPlan assessSeries(Series& series, const Answers& answers = {});

// What tells that two slices are of two patients; null where nothing does. What one of them leaves
// empty tells nothing, as long as they have something in common. Names of one ID and birth date are
// one name, spelled in two ways or changed.
const char* otherPatient(const DicomHeader& a, const DicomHeader& b);

// The worst of the findings' severities.
Verdict verdictOf(const std::vector<Finding>& findings);
// Sets the verdict. In what is refused nothing was put right: its repairs say only what was found.
void assignVerdict(Series& series);

// "slice 12", by instance number, or "a slice without number".
std::string sliceName(const DicomHeader& header);

// CT of which a volume could come: images of the CT storage classes.
bool isCt(const DicomHeader& header);
// ImageType says LOCALIZER.
bool isLocalizer(const DicomHeader& header);

}  // namespace trephine
