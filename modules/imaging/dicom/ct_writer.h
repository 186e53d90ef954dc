// Writes a volume as a CT series: one explicit little-endian file a slice, for phantoms, tests and
// cases that are handed on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "volume/volume.h"

namespace trephine {

struct CtSeriesText {
  std::string series_description;
  std::string body_part;
  // Whom it is of: nobody.
  std::string patient_name = "TREPHINE^PHANTOM";
  std::string patient_id = "PHANTOM";
};

// What a series has when it is written; `slices` are the SOP instances, in increasing k. Derived
// from the voxels, their geometry, and description and body part: equal ones give equal UIDs.
struct CtSeriesUids {
  std::string study, series, frame_of_reference;
  std::vector<std::string> slices{};
};
CtSeriesUids ctSeriesUids(const Volume& volume, const CtSeriesText& text);
// "IM0001.dcm" of slice 0.
std::string sliceFileName(int k);

// Whether the volume fits DICOM: its size, and its axes at right angles. Errors: CANNOT_WRITE.
Status checkCtSeries(const Volume& volume, const std::filesystem::path& folder);

// Makes `folder` and writes IM0001.dcm onwards, in increasing k, with the UIDs of ctSeriesUids(),
// so that equal volumes give equal files. Slices there of a patient of the same name make room.
// Rescale slope 1, intercept -1024 with unsigned 16-bit pixels where the HU allow, else intercept 0
// with signed ones. Errors: CANNOT_WRITE (nothing half-written is left), CANCELLED.
Status writeCtSeries(const Volume& volume, const CtSeriesText& text,
                     const std::filesystem::path& folder, const Progress& progress = Progress());

}  // namespace trephine
