// A case: the patient's voxels and all that an exercise needs to know of them. One value, made here
// and nowhere else, and cheap to copy: the voxels are shared and never change.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "imaging/common/source_identity.h"
#include "imaging/report/report.h"
#include "imaging/steps/anatomy.h"
#include "imaging/structure_importer.h"
#include "volume/label_map.h"
#include "volume/segmentation.h"
#include "volume/volume.h"

namespace trephine {

struct Case {
  std::shared_ptr<const Volume> volume;
  std::string sha256;                    // of its voxels
  std::string source;                    // as readCase() was told; empty: a person's own
  std::optional<Provenance> provenance;  // of what was imported
  // Whom it is of, where it was read from DICOM: to compare names with, and for nothing else.
  std::shared_ptr<const SourceIdentity> identity;
  std::string name;  // for the screen alone: it may be a series' description
  bool built_in = false;
  std::string stored;              // its id in the workstation's library; empty: not there
  std::optional<Anatomy> anatomy;  // what it shows; none where it was not asked
  std::shared_ptr<const LabelMap> structures;  // fitted to the volume; null: none
  bool structures_built_in = false;  // they came with it, and a file that is given replaces them
  std::vector<StructureCard> structure_cards;  // of the file that they are from, and what is to be
  std::vector<Warning> structure_warnings;     // said of it
};

// The exercises that a region of the body is for: "cranium", "abdomen"; "" where it is not known.
const char* exerciseAnatomy(BodyRegion region);

// Voxels that are in memory. `sha256` is theirs, or empty: then it is taken here.
Case caseOf(std::shared_ptr<const Volume> volume, std::string sha256 = "");

// `source` is "phantom:cranium", "phantom:abdomen", a DICOM folder or file, or a volume file
// (volume/volume_files.h); from a folder the best CT series is taken. Without landmarks, and
// without structures but those of a built-in case.
// Errors are those of the importer and the readers, OUT_OF_MEMORY, and NO_CASE for an empty source.
// Any thread, as all of these; reports progress and can be cancelled.
// `answers`: to what the importer asks of the series, by its codes.
Result<Case> readCase(const std::string& source, const Progress& progress = Progress(),
                      const Answers& answers = {});

// That writing `target`, a file or a folder, takes nothing of what the case was read from: it is
// none of a volume's files (voxels beside a header, names beside voxels), and neither a file that
// is in a folder of DICOM nor that folder itself. Error: CANNOT_WRITE. Reads a header at most.
Status keepsCase(const std::filesystem::path& target, const std::string& source);

// Gives other names to the segments that tell who it is of; how many there were
// (library/name_words.h).
using NameHider = std::function<int(Segmentation&, const SourceIdentity&)>;

// The structures of a file, instead of what it had; "" for none. What a person would be asked is
// taken as it is and said in `structure_warnings`. Errors: those of importStructures.
// With `hide` names that tell whom the case is of are hidden, where it knows that.
Result<Case> withLabels(Case of, const std::string& file, const Progress& progress = Progress(),
                        const NameHider& hide = {});
// How structures are put on a case: they are compared with what it was read from, and with `hide`
// names that tell whom it is of are hidden, where it knows that. Answers and thresholds are the
// caller's to set.
StructureRequest requestOf(const Case& of, const NameHider& hide);
// Those that were put on its grid, with what is to be said of them.
Case withFit(Case of, StructureFit fit);
// These structures, which are on the volume's grid, instead of what it had; null for none.
Case withStructures(Case of, std::shared_ptr<const LabelMap> structures);

}  // namespace trephine
