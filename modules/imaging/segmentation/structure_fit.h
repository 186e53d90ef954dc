// A segmentation from elsewhere on a CT: where it lies, what is lost on the CT's grid, whether its
// HU can be what its names say; as a report card with questions, like that of a series. Pure.
#pragma once

#include <optional>
#include <string>
#include <variant>
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
  int label = 0;                 // in StructureFit::map
  Vec3 colour{1.0};              // red, green, blue, 0 to 1
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
  // The part of the CT that the file's grid covers: of the CT's volume, and along i, j, k the CT's
  // voxels [low, high).
  double covers_percent = 0.0;
  VoxelBox covers;
  bool resampled = false;  // its grid is not the CT's or a part of it
  // Structures that share voxels in the file; of two, the one that stands first here has them.
  std::vector<std::string> overlapping{};
  // Shares of voxels were given, and a threshold (StructureRequest) chose: the importer sets it.
  bool fractional = false;
  std::vector<Finding> findings;  // notices, of all of it
  std::vector<Choice> choices;  // what only a person can answer, answered or not
};

// Choice: nobody has answered it, and one of its options uses the file.
using FitAnswer = std::variant<StructureFit, Choice>;

// Between which HU the median of a structure lies that is called so, by an English word of its
// name, else of its tissue; none where neither says anything.
struct HuOfKind {
  const char* kind;
  double low, high;
};
std::optional<HuOfKind> huOfKind(const std::string& name, const std::string& tissue = "");

// Puts the segmentation on the CT's grid by its place in the patient. `answers` to the choices:
// OVERLAP (smaller, first, last, or an order of one's own as "order:vessel,liver",
// overlap_order.h), HU_NOT_TISSUE (refuse, keep), MIRRORED (refuse, keep), NO_AFFINE (of a file of
// the CT's size that says nothing of its place: refuse, keep for where it says, ct for voxel by
// voxel). What nobody has answered: OVERLAP is taken as smaller; MIRRORED is the answer, as a
// Choice; so are the other two with `ask_all`, and without it they are taken by their last option
// (keep, ct) and said in findings. Errors: what was answered with refuse, by its code (notUsed);
// LABELS_ELSEWHERE (no voxel on the CT), HALF_OUTSIDE (of one structure half or more lies over a
// voxel beyond the CT), EMPTY_SEGMENTATION, BAD_CHOICE, CANCELLED, OUT_OF_MEMORY.
Result<FitAnswer> fitStructures(Segmentation segmentation, const Volume& ct,
                                const Answers& answers = {}, bool ask_all = true,
                                const Progress& progress = Progress());

// Why a file is not used: the choice was answered with refuse, or nobody is there to answer it.
Error notUsed(const Choice& choice);
// Where nobody is there to answer: the fit, or notUsed().
Result<StructureFit> fitOf(Result<FitAnswer> answer);

Json toJson(const StructureFit& fit);

}  // namespace trephine
