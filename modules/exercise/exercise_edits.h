// An exercise while a person edits it: what can be taken back, and what a new set of tissues does
// to the rest of the exercise. Pure.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exercise/exercise.h"

namespace trephine {

// The exercises before and after each step. One that a person makes of many small ones, as a drag
// does, is one step.
class ExerciseHistory {
 public:
  // Another exercise: nothing of the one before can be taken back.
  void begin(Exercise exercise);
  // It is `exercise` now. `what` says of what: edits of the same thing that follow one another are
  // one step until close().
  void note(Exercise exercise, const std::string& what);
  void close() { open_.clear(); }
  // It changed by itself, as by being saved under another name: no step.
  void settle(Exercise exercise) { now_ = shared(std::move(exercise)); }

  bool canUndo() const { return !undo_.empty(); }
  bool canRedo() const { return !redo_.empty(); }
  std::string undoWhat() const { return canUndo() ? undo_.back().what : std::string(); }
  std::string redoWhat() const { return canRedo() ? redo_.back().what : std::string(); }
  // The exercise that it would be; null where there is none.
  const Exercise* before() const { return canUndo() ? undo_.back().exercise.get() : nullptr; }
  const Exercise* after() const { return canRedo() ? redo_.back().exercise.get() : nullptr; }
  // The exercise that it is then; only where it can.
  const Exercise& undo();
  const Exercise& redo();

 private:
  using Shared = std::shared_ptr<const Exercise>;
  struct Step {
    Shared exercise;  // to go back or on to
    std::string what;
  };
  static Shared shared(Exercise exercise) {
    return std::make_shared<const Exercise>(std::move(exercise));
  }

  Shared now_ = shared({});
  std::vector<Step> undo_, redo_;
  std::string open_;  // what the last step is of, while it goes on
};
// Older steps go: an exercise with everything is some 20 KB.
constexpr std::size_t kMostSteps = 500;

// The map of an arm that goes with `landmark` from now on, or with "" is fixed where it is in this
// patient. From a landmark to another it keeps its offset; from a fixed place it stays there.
ExerciseMap movedTo(const Exercise& exercise, std::size_t arm, const std::string& landmark,
                    const std::vector<PlacedLandmark>& landmarks);

// The exercise with another set. Landmarks and looks that name a tissue which is no longer there: a
// landmark takes the solid tissue of the set, or its first; a look goes. What was done is said, a
// sentence each.
struct NewTissues {
  Exercise exercise;
  std::vector<std::string> notes;
};
NewTissues withTissues(Exercise exercise, const TissueSet& set);

// --- What an edit changes. `elsewhere`: the case lacks a structure, so the set for such cases is
// in force (Placement::elsewhere).

const TissueSet& tissuesInForce(const Exercise& exercise, bool elsewhere);
TissueSet& tissuesInForce(Exercise& exercise, bool elsewhere);

// withTissues() of the set in force.
NewTissues withTissuesInForce(Exercise exercise, const TissueSet& set, bool elsewhere);

// `exercise` with what can be changed while a session runs as `other` has it: tissues in force and
// controller.
Exercise withLiveOf(Exercise exercise, const Exercise& other, bool elsewhere);

// Both lie at the same places in any case: landmarks, structures, anatomy.
bool samePlaces(const Exercise& a, const Exercise& b);
// Both name the same files beside them, which a save copies into the exercise's folder.
bool sameFiles(const Exercise& a, const Exercise& b);
// Both are moved by the same devices at the same rate.
bool sameDevices(const Exercise& a, const Exercise& b);

// --- What goes along with an edit.

// A tool whose kind or shape is another now: a burr at least as long as its head, a cylinder's head
// at least as long as it is thick.
ToolDescription fitted(ToolDescription tool);
// The arm with that tool in hand at first; the one that it had stays at hand.
ExerciseArm withInHand(ExerciseArm arm, const std::string& tool);
// Another name of a landmark or a tool, and whatever names it.
void renameLandmark(Exercise& exercise, std::size_t landmark, const std::string& name);
void renameTool(Exercise& exercise, std::size_t tool, const std::string& name);
// Another landmark or arm as this one, under a name that nothing has.
void addLandmarkLike(Exercise& exercise, std::size_t landmark);
void addArmLike(Exercise& exercise, std::size_t arm);
// A landmark that is found by a ray, from above to the middle where it had none; or at the most of
// its tissue.
void findByRay(Landmark& landmark);
void findByBulk(Landmark& landmark);

// --- An exercise beside what it was opened as, or saved as: `opened`.

// The landmark is a place in this patient that a person has clicked.
bool isEntry(const Landmark& landmark, const Exercise& opened);
// Anything but the tissues in force and the controller is another.
bool isEdited(const Exercise& exercise, const Exercise& opened, bool elsewhere);
// Places in one patient go: they are again where the exercise was opened with them.
Exercise forAnotherCase(Exercise exercise, const Exercise& opened);
// `exercise` once it is on disk as `saved`: its name, its case and its files are those.
Exercise asSaved(Exercise exercise, const Exercise& saved);

}  // namespace trephine
