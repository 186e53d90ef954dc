// What an exercise consists of, as a file declares it: case, tissues, tools, arms, laws,
// controller. What an exercise does not name is not created, not stepped and not drawn.
// The file: JSON, resources/schemas/scene.md.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"
#include "base/result.h"
#include "haptics/haptic_core.h"
#include "exercise/landmark.h"
#include "exercise/locks.h"
#include "exercise/rig.h"
#include "exercise/exercise_card.h"
#include "exercise/exercise_outline.h"
#include "exercise/exercise_tool.h"
#include "tissue/tissue_look.h"
#include "tissue/tissue_set.h"
#include "volume/volume.h"

namespace trephine {

// Where an arm's workspace lies in the patient: at a landmark that is found in the case, or fixed.
struct ExerciseMap {
  std::string landmark;           // empty: `fixed` holds
  Vec3 offset_mm{0.0};            // of the device's origin from the landmark, landmark axes
  std::optional<WorkspaceMap> fixed;
  double motion_scale = 1.0;
  double force_scale = 1.0;
  bool operator==(const ExerciseMap&) const = default;
};

struct ExerciseArm {
  std::string name;                   // "left", "right"
  std::string tool;                   // a tool's id: in hand at first
  std::vector<std::string> other_tools;  // ids of those that it may be given; kMostTools in all
  ExerciseMap map;
  double max_force_N = 3.3;           // no more than this, whatever the device can give
  bool operator==(const ExerciseArm&) const = default;
};

struct ExerciseView {
  std::string landmark;       // looked at from outside; empty: the whole case from the front
  double distance_mm = 350.0;
  TissueLooks looks;  // to start with; a person may change them
  bool operator==(const ExerciseView&) const = default;
};

struct Exercise {
  std::string name;
  std::string anatomy;        // "cranium", "abdomen": which cases the exercise fits
  std::string case_source;    // "phantom:cranium", a path, or empty: given when it is run
  std::string labels_file;    // label map of that case, empty for none or given when it is run
  std::vector<std::string> structures;  // names of those that the exercise needs
  TissueSet tissues;
  // On a case that lacks a structure which is needed, or of which labels are not known; none:
  // these.
  std::optional<TissueSet> tissues_elsewhere;
  std::vector<Landmark> landmarks;
  std::vector<ExerciseTool> tools;
  std::vector<ExerciseArm> arms;
  std::vector<LawKind> laws;
  ForceAt force_at = ForceAt::tip;
  RemovalKind removal = RemovalKind::work;
  // Ids of the tissues that push by the seed paper's own rule of touch; empty: the program's rule.
  std::vector<std::string> touch_by_points;
  ControllerKind controller = ControllerKind::bounded;
  double rate_hz = 1000.0;
  std::string operator_file;  // default script, empty for none
  ExerciseView view;
  std::optional<ExerciseCard> card;        // said before it begins
  std::optional<ExerciseOutline> outline;  // drawn on the tissue
  Locks locks;                          // what is not changed while it is practised

  const ExerciseTool* findTool(const std::string& id) const;
  // The tools of an arm by number, as ArmParameters counts them; null beyond the last.
  const ExerciseTool* toolOf(std::size_t arm, std::size_t number) const;
  const Landmark* findLandmarkById(const std::string& id) const;
  bool operator==(const Exercise&) const = default;
};

// The exercise's card in this language, "en" or "zh_TW", or in English where it has no other; null
// where it has none.
const CardText* cardFor(const Exercise& exercise, std::string_view language);

// The exercise as it holds on this case instead of its own ("" is one that has no name): a label
// map that the exercise names beside its own case is of that one, and so are an outline without a
// frame and tissues that are known by a number of it, where the exercise has others for elsewhere.
// What is known by a structure's name holds anywhere (exercise_structures.h). Pure.
Exercise onCase(Exercise exercise, const std::string& case_source);

// Files that an exercise names are found beside it. Errors: MISSING_FILE, BAD_JSON, BAD_FIELD
// (file, field and value named; a name that is unknown or stands twice, too), BAD_TISSUE.
Result<Exercise> readExercise(const std::filesystem::path& file);
Result<Exercise> parseExercise(const Json& json, const std::filesystem::path& file);
// Self-contained: tissues inline and none for elsewhere, no file names, no label map, and a case
// only where it is a phantom (a path could name a patient).
Json toJson(const Exercise& exercise);

// What a recording keeps: the exercise as toJson() gives it, with what moved each arm.
struct RecordedExercise {
  Exercise exercise;
  Rig rig;
};
Json toJson(const RecordedExercise& recorded);
// From a file that may be anybody's: one that names a file is refused before any is opened. `where`
// is named in errors.
Result<RecordedExercise> parseRecordedExercise(const Json& json, const std::string& where);

// As a file that readExercise() reads: everything, tissues inline and those for elsewhere beside
// them, files named as the exercise has them: from the root, where it was read so. Neither the
// labels of a case nor the devices of its arms are an exercise's.
Json exerciseFile(const Exercise& exercise);

// What would be wrong with that file: an edited exercise is held to the rules of one that is read.
// The Error names the field. Asks the disk whether the files are there.
Status checkEdited(const Exercise& exercise);

// A landmark's place in a case, found once and used for maps, scripts and the camera.
struct PlacedLandmark {
  std::string id;
  LandmarkFrame frame;
};
// `labels` are fitted to the volume. Errors: those of checkLabels and findLandmark.
Result<std::vector<PlacedLandmark>> placeLandmarks(const Exercise& exercise, const Volume& volume,
                                                   const LabelMap* labels = nullptr,
                                                   const Progress& progress = Progress());

// NO_LABELS where a tissue is restricted to a label and there is no label map: it would be nowhere,
// and nothing would say so.
Status checkLabels(const TissueSet& tissues, const LabelMap* labels);

// The same exercise with every arm's map fixed at its landmark, and its outline where it lies in
// this case (placedOutline): what is recorded.
Exercise withFixedMaps(const Exercise& exercise, const std::vector<PlacedLandmark>& landmarks);

// By arm: the frame of its map's landmark, in which a script gives its waypoints.
std::vector<LandmarkFrame> armFrames(const Exercise& exercise,
                                     const std::vector<PlacedLandmark>& landmarks);

// What an arm renders at the exercise's rate, in the tissue's own numbers; of an arm whose dynamics
// are not known, as the usual one.
Renderable renderableOn(const ExerciseArm& arm, const std::optional<ArmDynamics>& dynamics,
                        double rate_hz);

// Damping and stiffness of a tissue, summed over the laws that the exercise names.
Impedance demandedOf(const Exercise& exercise, const Tissue& tissue);

// A tissue that is firmer than an arm can show: what is demanded, and what will be felt.
struct BoundedTissue {
  std::string arm, tissue;
  Impedance demanded, felt;
};
// Empty under another controller than `bounded`. Of arms whose dynamics are known.
std::vector<BoundedTissue> boundedTissues(const Exercise& exercise, const Rig& rig);

// What the core needs of an exercise whose maps are fixed (withFixedMaps) and whose tissues have
// the labels of their structures (exercise_structures.h); case/placement.h does all of it. A tissue
// without its label lies nowhere. Arms whose dynamics are not known are as the usual one.
HapticParameters hapticParameters(const Exercise& exercise, const Rig& rig = {});

}  // namespace trephine
