// Opening: an exercise, a case, its structures, and what of it is kept for the next.
#include <algorithm>

#include "base/codes.h"
#include "base/tr.h"
#include "case/codes.h"
#include "desk/codes.h"
#include "desk/desk.h"
#include "tissue/tissue_edits.h"
#include "volume/phantom.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

bool sameIds(const TissueSet& a, const TissueSet& b) {
  return std::ranges::equal(a.tissues, b.tissues, {}, &Tissue::id, &Tissue::id);
}

// The exercise that is open stays, on a case that has other structures.
OpenRequest ofStructures(OpenRequest request, const Case& of) {
  request.same_exercise = request.structures_alone = true;
  request.of = of;
  return request;
}

}  // namespace

bool Desk::mayOpen() {
  if (phase() != Phase::empty && phase() != Phase::ready) {
    fail({code::kBusy, tr("An exercise is running"), "", tr("Stop it, then open the other case")});
    return false;
  }
  if (isOpening()) {
    fail({code::kBusy, tr("Another case is being opened"), "",
          tr("Wait for it or cancel it first")});
    return false;
  }
  return true;
}

std::optional<Exercise> Desk::readExerciseOrFail(const std::filesystem::path& file) {
  Result<Exercise> exercise = readAllowedExercise(file, unlocked_ ? nullptr : &policy_);
  if (exercise) return *std::move(exercise);
  fail(exercise.error());
  return {};
}

bool Desk::isExercise(const std::filesystem::path& path) {
  const auto isSidecar = [&] { return isVolumeFile(path) && !readExercise(path); };  // of a .raw
  return path.extension() == ".json" && !isSidecar();
}

OpenRequest Desk::requestOf(Exercise exercise, const std::filesystem::path& file) const {
  OpenRequest request{std::move(exercise), file};
  if (placed_) request.shown = placed_->patient.volume;
  if (!unlocked_) request.policy = policy_;
  return request;
}

// The exercise in use, as it goes on with another case; else the first of the product's.
std::optional<OpenRequest> Desk::requestOfExercise() {
  if (!mayOpen()) return {};
  if (exercise_) {
    OpenRequest request = requestOf(forAnotherCase(*exercise_, opened_exercise_), exercise_file_);
    request.same_exercise = true;
    return request;
  }
  const std::filesystem::path file = defaultExercise("cranium");
  std::optional<Exercise> exercise = readExerciseOrFail(file);
  return exercise ? std::optional(requestOf(*std::move(exercise), file)) : std::nullopt;
}

void Desk::openExercise(const std::filesystem::path& file) {
  if (!mayOpen()) return;
  std::optional<Exercise> exercise = readExerciseOrFail(file);
  if (!exercise) return;
  exercise_chosen_ = true;
  const std::string source = exercise->case_source;
  openSource(requestOf(*std::move(exercise), file), source);
}

void Desk::openExercise(const std::filesystem::path& file, LoadCase load) {
  if (!mayOpen()) return;
  std::optional<Exercise> exercise = readExerciseOrFail(file);
  if (!exercise) return;
  exercise_chosen_ = true;
  OpenRequest request = requestOf(*std::move(exercise), file);
  request.source = request.exercise.case_source;
  request.load = std::move(load);
  open(std::move(request));
}

void Desk::openPhantom(const std::string& name) {
  if (!mayOpen()) return;
  if (exerciseFits(name)) return openSource(*requestOfExercise(), phantomSource(name));
  const std::filesystem::path file = defaultExercise(name);
  std::optional<Exercise> exercise = readExerciseOrFail(file);
  if (exercise) openSource(requestOf(*std::move(exercise), file), phantomSource(name));
}

void Desk::useExercise(const std::filesystem::path& file) {
  if (!mayOpen()) return;
  std::optional<Exercise> exercise = readExerciseOrFail(file);
  if (!exercise) return;
  exercise_chosen_ = true;
  const std::string source = exercise->case_source;
  // One that was made on a case of its own is for that.
  const bool any_case = source.empty() || phantomNamed(source);
  const Case* here = currentCase();
  OpenRequest request = requestOf(*std::move(exercise), file);
  if (!here || !any_case || (here->built_in && !source.empty())) {
    return openSource(std::move(request), source);
  }
  request.of = *here;
  open(std::move(request));
}

void Desk::openSource(OpenRequest request, const std::string& source) {
  if (source.empty() && placed_) {  // the open one, with what this exercise looks for in it
    request.of = placed_->patient;
    return open(std::move(request));
  }
  if (source.empty()) {  // the exercise waits for a case of the user's
    exercise_ = std::move(request.exercise);
    exercise_file_ = request.exercise_file;
    in_force_ = exercise_->controller;
    looks_ = exercise_->view.looks;
    opened_exercise_ = *exercise_;
    saved_tissues_.reset();
    history_.begin(*exercise_);
    say(DeskChange::exercise);
    say(DeskChange::locks);
    say(DeskChange::edits);
    return;
  }
  request.source = source;
  open(std::move(request));
}

void Desk::openImported(const Case& read, const std::filesystem::path& labels) {
  std::optional<OpenRequest> request = requestOfExercise();
  if (!request) return;
  request->of = read;
  if (!labels.empty()) request->structures = std::make_shared<StructureFile>(labels);
  request->any_exercise = !exercise_chosen_;
  open(*std::move(request));
}

void Desk::openStored(LoadCase load) {
  std::optional<OpenRequest> request = requestOfExercise();
  if (!request) return;
  request->any_exercise = true;
  request->load = std::move(load);
  open(*std::move(request));
}

void Desk::setStored(const std::string& id, const std::string& name) {
  if (!placed_) return;
  placed_->patient.stored = id;
  if (!name.empty()) placed_->patient.name = name;  // what its series was called may name somebody
  say(DeskChange::case_named);
}

void Desk::useLabels(const std::filesystem::path& file, const Answers& answers) {
  if (!mayOpen()) return;
  if (!placed_) {
    fail({code::kNoCase, tr("There is no case that a label map could belong to"), "",
          tr("Open the case first, then its label map")});
    return;
  }
  OpenRequest request = ofStructures(requestOf(*exercise_, exercise_file_), placed_->patient);
  request.structures = std::make_shared<StructureFile>(file);
  request.answers = answers;
  open(std::move(request));
}

void Desk::answer(const std::string& option) {
  // Of the case that it was asked about.
  if (!question_ || placed_->patient.volume != question_->request.of->volume) {
    question_.reset();
    return fail({code::kNotAsked, tr("What was asked about is not being opened any more"), "",
                 tr("Open the structures again")});
  }
  if (!mayOpen()) return;
  // On the exercise as it is by now.
  const StructureQuestion question = *std::exchange(question_, {});
  OpenRequest request = ofStructures(requestOf(*exercise_, exercise_file_), placed_->patient);
  request.structures = question.request.structures;
  request.answers = question.request.answers;
  request.answers[question.asked.choice.code] = option;
  open(std::move(request));
}

bool Desk::useStructures(const std::shared_ptr<const LabelMap>& structures) {
  if (phase() != Phase::ready || isOpening()) return false;
  placeAgain(structures, false);
  return true;
}

// The exercise on the open case with these structures; `of_edit`: its places were edited.
void Desk::placeAgain(const std::shared_ptr<const LabelMap>& structures, bool of_edit) {
  const Case& of = placed_->patient;
  open(ofStructures(requestOf(*exercise_, exercise_file_),
                    structures == of.structures ? of : withStructures(of, structures)),
       Opening{true, of_edit, false});
}

void Desk::open(OpenRequest request, const Opening& as) {
  if (!as.placing) question_.reset();  // structures that were made here leave it as it is
  const bool structures_alone = request.structures_alone;
  // Which one it will be, the case says once it is read.
  const bool known = !(request.any_exercise && (request.load || request.of));
  if (!request.same_exercise && known) {
    events_.onExerciseOpening(request.exercise, request.exercise_file);
  }
  opening_.run(
      [request = std::move(request)](const Progress& progress) mutable -> Result<OpenOutcome> {
        const std::shared_ptr<const Volume> shown = request.shown;
        Result<OpenOutcome> outcome = openOnDesk(std::move(request), progress);
        if (!outcome) return outcome;
        if (auto* opened = std::get_if<Opened>(&*outcome)) {
          if (Status added = addMirror(*opened, shown); !added) return added.error();
        }
        return outcome;
      },
      [this](Result<OpenOutcome> outcome) { opened(std::move(outcome)); });
  Opening opening = as;
  opening.structures_alone = structures_alone;
  go(opening);
}

// The outcome follows.
void Desk::endOpening() {
  ended_ = std::get<Opening>(activity_);
  activity_ = Idle{};
  say(DeskChange::opening_ended);
  say(DeskChange::phase);
}

void Desk::opened(Result<OpenOutcome> outcome) {
  if (!outcome) {
    if (ended_.of_edit && history_.canUndo()) goTo(history_.undo());
    if (auto* back = std::get_if<Opening>(&activity_)) {
      back->of_edit = false;       // and no further
      ended_.place_again = false;  // it is all that waited
    }
    if (placed_) say(DeskChange::placing_failed);
    return fail(outcome.error());
  }
  if (auto* question = std::get_if<StructureQuestion>(&*outcome)) {
    question_ = std::move(*question);
    const StructureQuestion asked = *question_;  // who is told may answer at once
    return events_.onQuestion(asked);
  }
  opened(std::get<Opened>(*std::move(outcome)));
}

// What was edited holds on the next case too.
void Desk::opened(Opened opened) {
  const Locks& kept = opened.same_exercise ? opened_exercise_.locks : opened.exercise.locks;
  const bool may_edit =
      unlocked_ || !(policy_.isLocked(Lock::tissues) || kept.contains(Lock::tissues));
  const bool was_elsewhere = isElsewhere();
  if (opened.structures_alone && placed_) {  // the library may have got it meanwhile
    opened.placed.patient.stored = placed_->patient.stored;
    opened.placed.patient.name = placed_->patient.name;
  }
  placed_ = std::move(opened.placed);
  placed_with_ = tissueTable(placed_->exercise.tissues);
  if (!opened.same_exercise) {
    exercise_ = std::move(opened.exercise);
    opened_exercise_ = *exercise_;
    saved_tissues_.reset();
    looks_ = exercise_->view.looks;
    history_.begin(*exercise_);
  } else if (!opened.structures_alone) {
    // Tissues and controller were edited while it was read, perhaps.
    exercise_ = forAnotherCase(*std::move(exercise_), opened_exercise_);
  }
  if (was_elsewhere != isElsewhere()) saved_tissues_.reset();  // of the other set
  if (!opened.structures_alone) brought_tissues_.reset();
  // The case's own, where they are of the same kinds: what was felt on it is felt again.
  if (opened.tissues && may_edit && sameIds(*opened.tissues, tissues())) {
    tissuesInForce(*exercise_, isElsewhere()) = *opened.tissues;
    tissuesSaved(*opened.tissues);
    brought_tissues_ = *opened.tissues;
  }
  // What was edited in a set that is not shown any more is not taken back unseen.
  if (was_elsewhere != isElsewhere()) history_.begin(*exercise_);
  history_.settle(*exercise_);
  history_.close();
  refreshPlaced();
  exercise_file_ = std::move(opened.exercise_file);
  in_force_ = exercise_->controller;
  if (opened.structures_alone) {
    say(DeskChange::exercise);
    say(DeskChange::edits);
    say(DeskChange::structures);
    return;
  }
  mirror_ = std::move(opened.mirror);
  carved_.reset();
  say(DeskChange::exercise);
  say(DeskChange::edits);
  say(DeskChange::locks);
  say(DeskChange::case_opened);
  say(DeskChange::phase);
  if (opened.no_labels) fail(*opened.no_labels);
  if (opened.no_structures) fail(*opened.no_structures);
  if (opened.no_tissues && may_edit) fail(*opened.no_tissues);
  if (placed_->error) fail(*placed_->error);
  arms_here_.read(*exercise_);
}

}  // namespace trephine
