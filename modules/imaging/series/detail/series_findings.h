// What the folder around a series, and reading its pixels, say of it.
#pragma once

#include <optional>
#include <vector>

#include "base/result.h"
#include "imaging/common/detail/stored_values.h"
#include "imaging/report/report.h"
#include "imaging/series/detail/scan.h"
#include "imaging/series/detail/series.h"

namespace trephine {

// --- After the scan ---
// Why no volume can come out of the folder; nothing where one can.
std::optional<Error> folderError(const ImportReport& report);
bool hasFinding(const SeriesReport& series, Code code);
// By its values or its name.
bool looksLikeLabels(const SeriesReport& series);
// Of a label map beside a CT: it is no wrong choice but a part of the case.
void sayWhatLabelsAreFor(SeriesReport& series);
// Refuses the series where files beside its own were not looked at (SCAN_STOPPED); a note where
// files elsewhere were not.
void addStoppedScan(const ScannedFiles& files, Series& series);
// Notes files beside its slices that are empty (INCOMPLETE).
void addEmptyFiles(const ScannedFiles& files, Series& series);
// Where a folder holds CT of several patients, or of several days of one: which of them each series
// is of, since nothing else that is shown tells them apart (PATIENTS, DAYS).
void saySeveral(std::vector<Series>& all);
// A finding that stays however the series is looked at; its questions go where it is a refusal.
void keepFinding(Series& series, Finding finding);

// --- While it is read ---
// Notes padding, and HU that were rounded or clamped.
void addValueFindings(const HuCounts& counts, SeriesReport& report);
// Asks HIGH_BITS: bits of compressed pixels above those that the header says are stored, where no
// overlay explains them: values, or debris.
void askAboutHighBits(const DicomHeader& slice, const Answers& answers, SeriesReport& report);
// The series is refused as a whole, rather than with a question about every slice that is not there
// any more. Returns SOURCE_VANISHED.
Error refuseVanished(SeriesReport& series);

}  // namespace trephine
