// Edits of the exercise by a person, the way back, and what a trainee may not change.
#include <algorithm>

#include "base/codes.h"
#include "base/tr.h"
#include "case/codes.h"
#include "desk/desk.h"
#include "exercise/codes.h"
#include "exercise/exercise_fields.h"

namespace trephine {

// --- Locks ---

// But for a PIN.
bool Desk::wouldBeLocked(Lock lock) const {
  const bool runs = phase() != Phase::empty && phase() != Phase::ready;
  const bool practised = practising_ || (practised_ && runs);
  return policy_.isLocked(lock) ||
         (practised && exercise_ && opened_exercise_.locks.contains(lock));
}

bool Desk::isLocked(Lock lock) const {
  return !unlocked_ && wouldBeLocked(lock);
}

void Desk::setPractising(bool practising) {
  if (std::exchange(practising_, practising) == practising) return;
  if (exercise_ && !opened_exercise_.locks.empty()) say(DeskChange::locks);
}

// What the exercise keeps is practised as it was saved: nobody's edit gets round it.
Status Desk::keptAsSaved() const {
  if (unlocked_ || !practising_) return {};
  const auto kept = [&](Lock lock) { return opened_exercise_.locks.contains(lock); };
  const std::string what =
      kept(Lock::tissues) && tissuesUnlikeExercise()
          ? tr("The exercise keeps its tissues, and they have been changed since it was saved")
      : kept(Lock::controller) && exercise_->controller != opened_exercise_.controller
          ? tr("The exercise keeps its controller, which has been changed since it was saved")
      : kept(Lock::rate) && exercise_->rate_hz != opened_exercise_.rate_hz
          ? tr("The exercise keeps its rate, which has been changed since it was saved")
          : std::string();
  if (what.empty()) return {};
  return Error{code::kLocked, what, "",
               tr("Save the exercise in Prepare, undo the change there, or try it from there")};
}

bool Desk::anyLocked() const {
  return isLocked(Lock::controller) || isLocked(Lock::tissues) || isLocked(Lock::rate);
}

bool Desk::tissuesWouldGo() const {
  return unlocked_ && exercise_ && tissues() != prescribedTissues() && wouldBeLocked(Lock::tissues);
}

// What an exercise keeps is as its own file has it.
const TissueSet& Desk::prescribedTissues() const {
  return opened_exercise_.locks.contains(Lock::tissues) ? ofExercise() : declaredTissues();
}

void Desk::setUnlocked(bool unlocked) {
  unlocked_ = unlocked;
  if (!unlocked && exercise_) takeBack();
  say(DeskChange::locks);
}

// What was changed while it was unlocked: controller and tissues are what they are prescribed to
// be, or what the exercise brings. A rate of another exercise is seen to when that is started.
void Desk::takeBack() {
  if (isLocked(Lock::tissues) && tissues() != prescribedTissues()) {
    tissuesInForce(*exercise_, isElsewhere()) = TissueSet(prescribedTissues());
    refreshPlaced();
    tellTissues();
    history_.begin(*exercise_);
    say(DeskChange::exercise);
    say(DeskChange::edits);
  }
  if (!isLocked(Lock::controller)) return;
  applyController(policy_.controller.value_or(opened_exercise_.controller));
  say(DeskChange::controller);
}

Status Desk::notLocked(Lock lock) const {
  if (!isLocked(lock)) return {};
  std::string what;
  switch (lock) {
    case Lock::controller:
      what = tr("The controller is locked on this workstation or by this exercise");
      break;
    case Lock::tissues:
      what = tr("The tissues are locked on this workstation or by this exercise");
      break;
    case Lock::rate:
      what = tr("The rate is locked on this workstation or by this exercise");
      break;
  }
  return Error{code::kLocked, what, "",
               policy_.isLocked(lock) ? unlocking(policy_) : tr("It can be changed in Prepare")};
}

// --- Edits ---

// After an edit: what is drawn and felt follows at once.
void Desk::refreshPlaced() {
  if (!placed_) return;
  placed_->exercise = placedExercise(onCase(*exercise_, placed_->patient.source), *placed_);
}

Status Desk::mayEdit(const Exercise& wanted) const {
  const TissueSet& wanted_tissues = tissuesInForce(wanted, isElsewhere());
  if (wanted_tissues != tissues()) {
    if (Status may = notLocked(Lock::tissues); !may) return may;
  }
  const auto id = &Tissue::id;
  if (heldSession() && !std::ranges::equal(wanted_tissues.tissues, tissues().tissues, {}, id, id)) {
    return Error{code::kBusy, tr("A running exercise keeps its list of tissues"), "",
                 tr("Stop it before tissues are added or removed")};
  }
  for (const FieldOf<Exercise>& field : kTouchFields) {
    const auto lock = kindOf(kLockNames, field.row.lock);
    if (!lock || valueOf(field, wanted) == valueOf(field, *exercise_)) continue;
    if (Status may = notLocked(*lock); !may) return may;
  }
  const Exercise live = withLiveOf(wanted, *exercise_, isElsewhere());
  if (live == *exercise_) return {};
  // Where an exercise enters a patient is of preparing a case.
  Exercise rest = live;
  rest.landmarks = exercise_->landmarks;
  if (anyLocked() && rest != *exercise_) {
    return Error{code::kLocked, tr("Exercises are not changed while anything is locked"), "",
                 policy_.locks.empty() ? tr("It can be changed in Prepare") : unlocking(policy_)};
  }
  if (phase() != Phase::ready && phase() != Phase::empty) {
    return Error{code::kBusy, tr("This cannot be changed while an exercise runs"), "",
                 tr("Stop it first")};
  }
  if (isOpening() && !isPlacing()) {
    return Error{code::kBusy, tr("A case is being opened"), "", tr("Try again in a moment")};
  }
  return checkEdited(wanted);
}

Status Desk::edit(const Exercise& wanted, const std::string& what) {
  if (!exercise_)
    return Error{code::kNoCase, tr("There is no exercise yet"), "", tr("Open a case first")};
  if (Status may = mayEdit(wanted); !may) return may;
  history_.note(wanted, what);
  if (put(wanted)) say(DeskChange::exercise);
  say(DeskChange::edits);
  return {};
}

Status Desk::edit(const std::string& what, const std::function<void(Exercise&)>& change) {
  if (!exercise_) return edit(Exercise(), what);  // which says so
  Exercise wanted = *exercise_;
  change(wanted);
  Status done = edit(wanted, what);
  closeEdit();
  return done;
}

void Desk::setTissues(const TissueSet& tissues, const std::string& what) {
  if (!exercise_) return;
  Exercise wanted = *exercise_;
  tissuesInForce(wanted, isElsewhere()) = tissues;
  if (Status done = edit(wanted, what); !done) {
    fail(done.error());
    say(DeskChange::exercise);  // as it was
  }
}

// True where more than tissues and controller changed.
bool Desk::put(Exercise wanted) {
  const bool places_stay = samePlaces(wanted, *exercise_);
  const bool devices_stay = sameDevices(wanted, *exercise_);
  const bool live_alone = withLiveOf(wanted, *exercise_, isElsewhere()) == *exercise_;
  const bool new_set = tissuesInForce(wanted, isElsewhere()) != tissues();
  const bool new_controller = wanted.controller != exercise_->controller;
  const ControllerKind controller = wanted.controller;
  exercise_ = std::move(wanted);
  refreshPlaced();
  if (!devices_stay) arms_here_.read(*exercise_);
  if (new_set) tellTissues();
  if (new_controller) {
    applyController(controller);
    say(DeskChange::controller);
  }
  if (!places_stay && phase() == Phase::ready) placeEdited();
  return !live_alone;
}

// What is edited while that goes on is placed after it.
void Desk::placeEdited() {
  if (auto* opening = std::get_if<Opening>(&activity_)) {
    opening->place_again = true;
  } else {
    placeAgain(placed_->patient.structures, true);
  }
}

const Landmark* Desk::entry() const {
  if (!exercise_) return nullptr;
  for (const Landmark& landmark : exercise_->landmarks) {
    if (isEntry(landmark, opened_exercise_)) return &landmark;
  }
  return nullptr;
}

bool Desk::placeEntry(const std::optional<Landmark>& entry) {
  if (phase() != Phase::ready || isOpening()) return false;
  Exercise wanted = *exercise_;
  for (Landmark& landmark : wanted.landmarks) {
    if (entry && landmark.id == entry->id) landmark = *entry;
    if (!entry && isEntry(landmark, opened_exercise_)) {
      landmark = *opened_exercise_.findLandmarkById(landmark.id);
    }
  }
  history_.close();
  if (Status done = edit(wanted, "entry"); !done) {
    fail(done.error());
    return false;
  }
  if (!isOpening()) placeEdited();  // the same place once more
  return isOpening();
}

void Desk::undoEdit() {
  if (mayGoTo(history_.before())) goTo(history_.undo());
}

void Desk::redoEdit() {
  if (mayGoTo(history_.after())) goTo(history_.redo());
}

bool Desk::mayGoTo(const Exercise* step) {
  if (!exercise_ || !step) return false;
  const Status may = mayEdit(*step);
  if (!may) fail(may.error());
  return may.ok();
}

void Desk::goTo(Exercise exercise) {
  (void)put(std::move(exercise));
  say(DeskChange::exercise);
  say(DeskChange::edits);
}

bool Desk::exerciseEdited() const {
  return exercise_ && isEdited(*exercise_, opened_exercise_, isElsewhere());
}

void Desk::exerciseSaved(const std::filesystem::path& file) {
  const Result<Exercise> saved = readExercise(file);
  if (!exercise_ || !saved) return;
  // What earlier steps named lies there no longer.
  const bool replaced = exercise_file_ == file && !sameFiles(*exercise_, *saved);
  exercise_file_ = file;
  // The open case is its own now, and its files lie elsewhere.
  exercise_ = asSaved(*std::move(exercise_), *saved);
  opened_exercise_ = *exercise_;
  saved_tissues_.reset();
  if (placed_) placed_->patient.source = saved->case_source;
  refreshPlaced();
  replaced ? history_.begin(*exercise_) : history_.settle(*exercise_);
  say(DeskChange::exercise);
  say(DeskChange::edits);
}

// --- What a running session follows at once ---

void Desk::tellTissues() {
  if (!session()) return;
  if (Status set = session()->setTissues(placedTissues()); !set) fail(set.error());
}

void Desk::noteController(ControllerKind in_force) {
  if (std::exchange(in_force_, in_force) != in_force) say(DeskChange::controller);
}

void Desk::setController(ControllerKind kind) {
  if (!exercise_) return;
  if (kind != exercise_->controller) {
    if (Status may = notLocked(Lock::controller); !may) {
      fail(may.error());
      return say(DeskChange::controller);
    }
  }
  applyController(kind);
}

void Desk::applyController(ControllerKind kind) {
  exercise_->controller = kind;
  refreshPlaced();
  history_.settle(*exercise_);
  if (!session()) noteController(kind);
  if (session() && !session()->setController(kind)) {
    fail({code::kBusy, tr("Too many changes are waiting"), tr("the haptic loop"), tr("Try again")});
  }
}

}  // namespace trephine
