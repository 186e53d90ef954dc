// A case: the patient's voxels and all that an exercise needs to know of them. One value, made here
// and nowhere else, and cheap to copy: the voxels are shared and never change.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "imaging/report/report.h"
#include "scene/scene.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

struct Case {
  std::shared_ptr<const Volume> volume;
  std::string sha256;                    // of its voxels
  std::optional<Provenance> provenance;  // of what was imported
  std::string name;                      // for the screen alone: it may be a series' description
  bool built_in = false;
  std::shared_ptr<const LabelMap> labels;  // fitted to the volume; null: none
  bool labels_built_in = false;            // they came with it, and one that is given replaces them

  // In the scene that it was placed in: where its landmarks are, or why not. It can be looked at
  // all the same.
  std::vector<PlacedLandmark> landmarks;
  std::optional<Error> misfit;
};

// Voxels that are in memory. `sha256` is theirs, or empty: then it is taken here.
Case caseOf(std::shared_ptr<const Volume> volume, std::string sha256 = "");

// `source` is "phantom:cranium", "phantom:abdomen", a DICOM folder or file, or a volume file
// (volume/volume_files.h); from a folder the best CT series is taken. Without landmarks, and
// without labels but those of a built-in case.
// Errors are those of the importer and the readers, OUT_OF_MEMORY, and NO_CASE for an empty source.
// Any thread, as all of these; reports progress and can be cancelled.
Result<Case> readCase(const std::string& source, const Progress& progress = Progress());

// The label map of a file, instead of what it had; "" for none. Errors: those of readLabelMap and
// fitTo.
Result<Case> withLabels(Case of, const std::string& file);

// Placed in a scene: with the label map that it names, unless one was given, and its landmarks.
// Error: CANCELLED; all others are the case's `misfit`.
Result<Case> placedIn(const Scene& scene, Case of, const Progress& progress = Progress());

// The scene's own case, placed in it.
Result<Case> openCase(const Scene& scene, const Progress& progress = Progress());

}  // namespace trephine
