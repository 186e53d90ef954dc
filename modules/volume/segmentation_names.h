// What a file, or one beside it, calls the numbers of a label map. For this room's .cpp files.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "base/range.h"
#include "volume/segmentation.h"
#include "volume/volume_files.h"

namespace trephine::file_format {

// What a file may call a structure by; a case counts to 255.
constexpr Range kLabelNumbers{1, 32767};
// 3D Slicer's tag for our tissue of a segment.
constexpr std::string_view kTissueTag = "Trephine.Tissue:";

struct NamedLabel {
  int label = 0;  // its number in the file
  Segmentation::Segment segment;
};

// 3D Slicer's own words on each segment of a NRRD, in the order of their numbers, and by the same
// keys what the table of labels in a NIfTI says.
std::vector<NamedLabel> segmentsNamedIn(const VolumeFileHeader& header);

// From a file beside the label map; none where there is none. Errors: BAD_JSON, BAD_FIELD,
// BAD_NAMES.
Result<std::vector<NamedLabel>> namesBeside(const std::filesystem::path& file);

// "liver" of "liver.nii.gz" and of "liver.seg.nrrd".
std::filesystem::path withoutEndings(const std::filesystem::path& file);

}  // namespace trephine::file_format
