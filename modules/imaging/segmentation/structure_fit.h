// A segmentation from elsewhere on a CT: where it lies, what is lost on the CT's grid, whether its
// HU can be what its names say; as a report card with questions, like that of a series. Pure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "imaging/report/report.h"
#include "volume/label_map.h"
#include "volume/segmentation.h"
#include "volume/volume.h"

namespace trephine {

// One structure of it, as it lies on the CT.
struct StructureCard {
  std::string name;
  int label = 0;
  Vec3 colour{1.0};
  std::size_t voxels = 0;        // of the CT
  double ml = 0.0;               // on the CT's grid
  double ml_in_file = 0.0;       // on its own, before overlaps were settled
  double outside_percent = 0.0;  // of it, beyond the CT
  // HU of its voxels: 5th percentile, median, 95th; none where it has no voxel.
  std::optional<std::array<double, 3>> hu;
  std::vector<Finding> findings;  // notices
};

struct StructureFit {
  LabelMap map;  // on the CT's grid, with the names
  std::string format;
  std::vector<StructureCard> structures;  // in the file's order
  // The part of the CT that the file's grid covers: of its volume, and along i, j, k the CT's
  // voxels [low, high).
  double covers_percent = 0.0;
  VoxelBox covers;
  bool resampled = false;  // its grid is not the CT's or a part of it
  // Those that share voxels in the file, in the order in which they have them: the first wins.
  std::vector<std::string> overlapping{};
  bool fractional = false;  // voxels were shares, of which a threshold took some
  std::vector<Finding> findings;
  std::vector<Choice> choices;  // what only a person can answer, answered or not
};

// HU that a structure of this name, or of this tissue, can have in its middle; none where the name
// says nothing.
struct HuOfKind {
  const char* kind;
  double low, high;
};
std::optional<HuOfKind> huOfKind(const std::string& name, const std::string& tissue = "");

// Puts the segmentation on the CT's grid by its place in the patient. `answers` to the choices:
// OVERLAP (smaller, first, last, or an order of one's own as "order:vessel,liver",
// overlap_order.h), HU_NOT_TISSUE (refuse, keep), NO_AFFINE (of a file of the CT's size that says
// nothing of its place: refuse, ct for voxel by voxel, keep). `ask_all`: an open choice whose first option is
// to refuse is an Error of its code, else it is taken as "keep" and said. `open`: the choice that
// the Error is of, where nobody has answered it; else it is left as it is. Errors: LABELS_ELSEWHERE,
// HALF_OUTSIDE, MIRRORED, EMPTY_SEGMENTATION, BAD_CHOICE, CANCELLED, OUT_OF_MEMORY.
Result<StructureFit> fitStructures(Segmentation segmentation, const Volume& ct,
                                   const Answers& answers = {}, bool ask_all = true,
                                   const Progress& progress = Progress(),
                                   std::optional<Choice>* open = nullptr);

Json toJson(const StructureFit& fit);

}  // namespace trephine
