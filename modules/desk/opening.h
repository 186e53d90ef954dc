// From what was asked for to an exercise on a case: reads the case, asks what a person has to
// decide about its structures, and places the exercise. Without state; any thread.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "case/placement.h"
#include "exercise/exercise.h"
#include "exercise/policy.h"
#include "imaging/structure_importer.h"
#include "library/stored_case.h"
#include "tissue/tissue_set.h"

namespace trephine {

// Reads a case of the library.
using LoadCase = std::function<Result<StoredCase>(const Progress&)>;

struct OpenRequest {
  Exercise exercise;
  std::filesystem::path exercise_file;
  bool same_exercise = false;  // the one that is open, as it is edited
  bool any_exercise = false;   // nobody chose it: one that fits what the case shows is as good
  // The case: at hand, or to be loaded; else the one that `source` names is read.
  std::optional<Case> of{};
  LoadCase load{};
  std::string source{};
  // Structures from this file instead of what the case has; null: those.
  std::shared_ptr<StructureFile> structures{};
  Answers answers{};              // about them
  bool structures_alone = false;  // the open case with others of them: what is asked is a person's
  std::shared_ptr<const Volume> shown{};  // the view has a copy of it
  std::optional<Policy> policy{};         // what is locked; empty: nothing
};

// An exercise on a case.
struct Opened {
  Exercise exercise;
  std::filesystem::path exercise_file;
  bool same_exercise = false;
  bool structures_alone = false;
  Placement placed{};
  std::optional<TissueSet> tissues{};  // the stored case's own
  // Why the case came without its structures, without those of the file, or without its tissues.
  std::optional<Error> no_structures{}, no_labels{}, no_tissues{};
  Volume mirror{};  // a copy of its voxels for a view: addMirror()
};

// What a person is asked about a file with structures that can be used; it is not used yet.
struct StructureQuestion {
  StructureAsked asked;
  OpenRequest request;  // to be opened again with the answer
};

using OpenOutcome = std::variant<Opened, StructureQuestion>;

// Errors: those of reading, of labels, and CANCELLED, OUT_OF_MEMORY; LOCKED is never one, as
// readAllowedExercise() has been asked before.
Result<OpenOutcome> openOnDesk(OpenRequest request, const Progress& progress);

// The copy of its voxels, unless the view has them already (`shown`). Errors: OUT_OF_MEMORY.
Status addMirror(Opened& opened, const std::shared_ptr<const Volume>& shown);

// The only way to an exercise of a file: what is locked is asked each time, since the file may have
// changed. `policy`: null where nothing is locked. Errors: those of readExercise(),
// checkExercise().
Result<Exercise> readAllowedExercise(const std::filesystem::path& file, const Policy* policy);

// The exercise that fits a case of this anatomy, among the product's own.
std::filesystem::path defaultExercise(const std::string& anatomy);

}  // namespace trephine
