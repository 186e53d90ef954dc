// A DICOM Segmentation: structures that were outlined elsewhere, on the grid of their frames.
//
// Read are binary and fractional ones, in the transfer syntaxes of the room's README; frames in any
// order, with none where a structure has no voxel. Nothing is guessed: what leaves in doubt where a
// frame lies is refused.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "imaging/common/source_ids.h"
#include "volume/segmentation.h"

namespace trephine {

struct DicomSegmentation {
  // Format "DICOM SEG". Axes i = rows' direction, j = columns' direction, k = i x j, in LPS; from
  // the first to the last place that has a frame. A segment's value is its number in the file, or
  // its place in the list where a number is over kMostStructures.
  Segmentation segmentation;
  SourceIds of;                     // `series` where it refers to one alone
  bool fractional = false;
  std::vector<std::string> series;  // hashes of those that it refers to, each once
};

// The SOP class of a DICOM file; empty for any other, and for what cannot be read. Cheap, on any
// thread.
std::string dicomKind(const std::filesystem::path& file, const Progress& progress = Progress());
// Whether files of this SOP class are segmentations: of segments that may overlap, or a label map.
bool isSegmentation(const std::string& sop_class);
inline bool isDicomSegmentation(const std::filesystem::path& file) {
  return isSegmentation(dicomKind(file));
}

// Whether it says how much of a voxel a structure has; reads the header alone. Errors: those of
// readDicomSegmentation().
Result<bool> isFractional(const std::filesystem::path& file, const Progress& progress = Progress());

// A voxel of a fractional segmentation is of a segment where its share of the highest value is at
// least `threshold`, of 0 to 1, and not 0. Errors: UNREADABLE (not there, no DICOM, cut, damaged),
// NOT_SEGMENTATION, UNSUPPORTED_SEGMENTATION (of another kind), UNSUPPORTED_TRANSFER_SYNTAX,
// SIZE_MISMATCH, NO_FRAMES, NO_GEOMETRY (a frame's place, orientation or pixel spacing is not there
// or no such thing), FRAMES_DIFFER (they do not lie in one straight stack), UNEVEN_SPACING,
// TOO_LARGE, TOO_MANY_STRUCTURES, BAD_THRESHOLD, OUT_OF_MEMORY, CANCELLED. Memory is taken for one
// layer more than come out.
Result<DicomSegmentation> readDicomSegmentation(const std::filesystem::path& file,
                                                double threshold = 0.5,
                                                const Progress& progress = Progress());

}  // namespace trephine
