// The header of a DICOM Segmentation as plain values, and where its pixels lie.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "imaging/dicom/detail/dicom_file.h"
#include "imaging/dicom/detail/frame_stack.h"

namespace trephine {

// Label Map Segmentation Storage (PS3.4 B.5, 2024), newer than DCMTK 3.6.7.
inline constexpr const char* kLabelMapStorage = "1.2.840.10008.5.1.4.1.1.66.7";

struct SegHeader {
  struct Segment {
    int number = 0;
    std::string name;
    std::optional<Vec3> colour;
  };
  std::string study, frame_of_reference;
  std::vector<std::string> series;  // UIDs, each once
  bool binary = true;
  bool label_map = false;  // pixels are segments' numbers; frames are of no segment
  int most = 255;          // the value of a fractional one that stands for 1
  DicomHeader pixels;
  std::vector<Segment> segments;
  std::vector<FramePlane> planes;  // of each frame
  std::vector<int> of;             // the number of each frame's segment
  std::optional<double> between_mm, thickness_mm;
  std::vector<std::string> notes;
};

// The error UNREADABLE, of the file that is read.
Error unreadableSegmentation(const std::string& what);

// Errors: UNREADABLE, NOT_SEGMENTATION, UNSUPPORTED_SEGMENTATION, SIZE_MISMATCH, and those of
// memory. DCMTK's objects nest: to be called on a worker's thread (workers.h), whose stack is
// bounded.
Result<SegHeader> readSegHeader(const std::filesystem::path& file, const Progress& progress);

}  // namespace trephine
