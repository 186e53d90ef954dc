// Structures as a DICOM Segmentation, with the CT that they are of beside it: for other programs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "base/tr.h"
#include "imaging/dicom/ct_writer.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

// The CT that a volume was read from, as its files name it. They find the patient where the CT is
// kept, so nothing beside a case holds them: whoever has the CT's folder at hand passes them.
struct RawSourceUids {
  struct Slice {
    std::string sop_class, sop_instance;
    int frame = 0;  // of a file of several, from 1; 0: of one
    Vec3 position_mm{0.0};
  };
  std::string study, series, frame_of_reference;
  std::vector<Slice> slices{};  // in any order
};

struct SegWriting {
  // Of the CT's files; the segmentation has its patient, too.
  CtSeriesText text{"Trephine case", "", "TREPHINE^CASE", "CASE"};
  std::optional<RawSourceUids> source{};  // to refer to it, and write no CT
};

struct WrittenStructures {
  std::vector<std::string> notes;  // structures that were left out, and the like: sentences
};

// Makes `folder` where it is not there and writes "CT" (as writeCtSeries() does) and
// "structures.dcm", a binary segmentation of that CT, into it. Both are of one new study and frame
// of reference, whose UIDs are derived from what is written, and of nobody. With `source`
// "structures.dcm" alone, which refers to that CT: to the slice nearest to each of its frames,
// where one lies within half a step.
//
// Frames are those of slices with voxels; a structure without one is left out. Names are cut to 64
// characters. The map lies on the CT's grid. Errors: CANNOT_WRITE (what is there already stays, and
// nothing half-written is left), NO_STRUCTURES, LABELS_ELSEWHERE (another grid), BAD_SOURCE (no
// UIDs), TOO_LARGE, OUT_OF_MEMORY, CANCELLED.
Result<WrittenStructures> writeStructuresAsDicom(const Volume& ct, const LabelMap& map,
                                                 const std::filesystem::path& folder,
                                                 const SegWriting& writing = {},
                                                 const Progress& progress = Progress());

}  // namespace trephine
