// An exercise on a case: where the one finds in the other what it needs, or why it does not.
// Neither is changed by it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "case/case.h"
#include "exercise/exercise.h"

namespace trephine {

struct Placement {
  Case patient;
  // The exercise as it runs there: the tissues in force with the labels of the case's structures,
  // maps fixed, the outline in the patient.
  Exercise exercise;
  bool elsewhere = false;  // in force are its tissues for cases that lack a structure
  // The case's structures and the shells that tissues ask for; null: none.
  std::shared_ptr<const LabelMap> labels;
  std::vector<PlacedLandmark> landmarks;
  std::vector<Warning> warnings;
  // Why the exercise cannot run on the case, which can be looked at all the same.
  std::optional<Error> error;
};

// With the label map that the exercise names, unless one was given, and its landmarks. What the
// exercise says of a case of its own has to hold of this one (onCase). A case that shows another
// anatomy is warned of (OTHER_ANATOMY, NO_VAULT). Where a landmark has no place in it, the
// landmarks are where their rays meet the body, with the warning NO_LANDMARK. Error: CANCELLED; all
// others are `Placement::error`. `hide` as of withLabels(). Any thread; takes a second on a large
// case.
Result<Placement> place(const Exercise& exercise, Case patient,
                        const Progress& progress = Progress(), const NameHider& hide = {});

// The exercise's own case, with the exercise placed in it. Errors: those of readCase() and place().
Result<Placement> openCase(const Exercise& exercise, const Progress& progress = Progress(),
                           const NameHider& hide = {});

// `Placement::exercise` of an exercise that was edited since, with the labels and landmarks that
// were found. Pure.
Exercise placedExercise(const Exercise& exercise, const Placement& in);

}  // namespace trephine
