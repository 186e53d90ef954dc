// Structures of a CT from a file of any kind that is read: names, place, HU; whether they belong to
// the CT at all; questions where a person has to decide. What other rooms use.
#pragma once

#include <filesystem>
#include <functional>

#include "base/progress.h"
#include "base/result.h"
#include "imaging/common/source_ids.h"
#include "imaging/segmentation/structure_fit.h"
#include "volume/segmentation.h"
#include "volume/volume.h"

namespace trephine {

struct StructureRequest {
  Answers answers;
  // Whether an open choice whose first option is to refuse is an Error of its code, or taken as
  // "keep" and said.
  bool ask_all = true;
  // What the CT is of; empty where it is not known (a volume file).
  SourceIds ct{};
  double threshold = 0.5;  // of a fractional DICOM SEG
  bool ask_threshold = false;  // which is then an Error THRESHOLD
  // Gives other names to those that tell who the patient is, before anything is said or made of
  // them; how many there were. Empty: the names stay.
  std::function<int(Segmentation&)> hide_names{};
};

// RENAMED_STRUCTURE among the findings says that names were hidden; SOURCE_UNCHECKED that whose the
// file is could not be told. A DICOM SEG belongs to the CT by its frame of reference. One with another is asked about
// (OTHER_FRAME: refuse, keep) where its grid lies within half a voxel on the CT's; else it is
// refused: OTHER_PATIENT where the study is another one as well, else OTHER_FRAME.
// Other errors: those of readSegmentation() or readDicomSegmentation(), and fitStructures(). Any
// thread.
Result<StructureFit> importStructures(const std::filesystem::path& file, const Volume& ct,
                                      const StructureRequest& request = {},
                                      const Progress& progress = Progress());

}  // namespace trephine
