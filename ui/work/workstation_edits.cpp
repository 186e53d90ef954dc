// Edits of the exercise by a person, and the way back.
#include <algorithm>

#include "scene/scene_structures.h"
#include "session/arm_devices.h"
#include "tissue/tissue_edits.h"
#include "ui/common/words.h"
#include "ui/work/workstation.h"

namespace trephine {

namespace {

// What can be changed while an exercise runs made the same.
Scene withLiveOf(Scene scene, const Scene& other) {
  scene.tissues = other.tissues;
  scene.controller = other.controller;
  return scene;
}

// Where it lies: the case's, not a person's.
void keepCase(Scene& scene, const Scene& of) {
  scene.case_source = of.case_source;
  scene.labels_file = of.labels_file;
}

bool samePlaces(const Scene& a, const Scene& b) {
  const auto same_place = [](const Tissue& one, const Tissue& other) {
    return one.id == other.id && one.structure == other.structure && one.shell == other.shell;
  };
  // Whether the case is one for the anatomy is said with its places.
  return a.landmarks == b.landmarks && a.structures == b.structures && a.anatomy == b.anatomy &&
         std::ranges::equal(a.tissues.tissues, b.tissues.tissues, same_place);
}

// The files beside the scene: what a save copies into the exercise's folder.
bool sameFiles(const Scene& a, const Scene& b) {
  return a.operator_file == b.operator_file &&
         std::ranges::equal(
             a.tools, b.tools, {}, [](const SceneTool& t) { return t.look.mesh; },
             [](const SceneTool& t) { return t.look.mesh; });
}

bool sameDevices(const Scene& a, const Scene& b) {
  return a.rate_hz == b.rate_hz &&
         std::ranges::equal(a.arms, b.arms, [](const SceneArm& one, const SceneArm& other) {
           return one.name == other.name;
         });
}

}  // namespace

Status Workstation::mayEdit(const Scene& wanted) const {
  if (wanted.tissues != scene_->tissues) {
    if (Status may = notLocked(Lock::tissues, "The tissues are"); !may) return may;
  }
  const auto id = &Tissue::id;
  if (session_ && !std::ranges::equal(wanted.tissues.tissues, scene_->tissues.tissues, {}, id, id)) {
    return Error{"BUSY", "A running exercise keeps its list of tissues", "",
                 "Stop it before tissues are added or removed"};
  }
  if (wanted.controller != scene_->controller) {
    if (Status may = notLocked(Lock::controller, "The controller is"); !may) return may;
  }
  if (wanted.rate_hz != scene_->rate_hz) {
    if (Status may = notLocked(Lock::rate, "The rate is"); !may) return may;
  }
  // Where an exercise enters a patient is of preparing a case.
  Scene rest = withLiveOf(wanted, *scene_);
  rest.landmarks = scene_->landmarks;
  const bool places_alone = sameScene(rest, *scene_);
  if (places_alone && sameScene(withLiveOf(wanted, *scene_), *scene_)) return {};
  if (anyLocked() && !places_alone) {
    return Error{"LOCKED", "Exercises are not changed while anything is locked", "",
                 unlockWords(policy_).toStdString()};
  }
  if (phase_ != Phase::ready && phase_ != Phase::empty) {
    return Error{"BUSY", "This cannot be changed while an exercise runs", "", "Stop it first"};
  }
  if (isOpening() && !placing_) {
    return Error{"BUSY", "A case is being opened", "", "Try again in a moment"};
  }
  return checkEdited(wanted);
}

Status Workstation::edit(const Scene& wanted, const std::string& what) {
  if (!scene_) return Error{"NO_CASE", "There is no exercise yet", "", "Open a case first"};
  if (Status may = mayEdit(wanted); !may) return may;
  history_.note(wanted, what);
  if (take(wanted)) emit sceneChanged();
  emit editsChanged();
  return {};
}

Status Workstation::edit(const std::string& what, const std::function<void(Scene&)>& change) {
  if (!scene_) return edit(Scene(), what);  // which says so
  Scene wanted = *scene_;
  change(wanted);
  Status done = edit(wanted, what);
  closeEdit();
  return done;
}

void Workstation::setTissues(const TissueSet& tissues, const std::string& what) {
  if (!scene_) return;
  Scene wanted = *scene_;
  wanted.tissues = tissues;
  if (Status done = edit(wanted, what); !done) {
    fail(done.error());
    emit sceneChanged();  // as it was
  }
}

// True where more than tissues and controller changed.
bool Workstation::take(Scene wanted) {
  const LabelMap* labels = case_ ? case_->labels.get() : nullptr;
  placeTissues(wanted.tissues, labels);
  const bool places_stay = samePlaces(wanted, *scene_);
  const bool devices_stay = sameDevices(wanted, *scene_);
  const bool live_alone = sameScene(withLiveOf(wanted, *scene_), *scene_);
  if (wanted.tissues_elsewhere != scene_->tissues_elsewhere) {
    one_set_ = !wanted.tissues_elsewhere;
    elsewhere_ = wanted.tissues_elsewhere;
  }
  const bool new_set = wanted.tissues != scene_->tissues;
  const bool new_controller = wanted.controller != scene_->controller;
  const ControllerKind controller = wanted.controller;
  scene_ = std::move(wanted);
  history_.settle(*scene_);
  if (!devices_stay) readArms();
  if (new_set) applyTissues(scene_->tissues);
  if (new_controller) {
    applyController(controller);
    emit controllerChanged();
  }
  if (!places_stay && case_ && phase_ == Phase::ready) placeEdited();
  return !live_alone;
}

// What is edited while that goes on is placed after it.
void Workstation::placeEdited() {
  place_again_ = isOpening();
  if (place_again_) return;
  const Status placed = placeAgain(case_->structures);
  placing_edit_ = placed.ok();
  if (!placed) fail(placed.error());
}

bool Workstation::isEntry(const Landmark& landmark) const {
  const Landmark* of_file = opened_scene_.findLandmarkById(landmark.id);
  return landmark.is_place && of_file && landmark != *of_file;
}

const Landmark* Workstation::entry() const {
  if (!scene_) return nullptr;
  for (const Landmark& landmark : scene_->landmarks) {
    if (isEntry(landmark)) return &landmark;
  }
  return nullptr;
}

bool Workstation::placeEntry(const std::optional<Landmark>& entry) {
  if (!case_ || phase_ != Phase::ready || isOpening()) return false;
  Scene wanted = *scene_;
  for (Landmark& landmark : wanted.landmarks) {
    if (entry && landmark.id == entry->id) landmark = *entry;
    if (!entry && isEntry(landmark)) landmark = *opened_scene_.findLandmarkById(landmark.id);
  }
  history_.close();
  if (Status done = edit(wanted, "entry"); !done) {
    fail(done.error());
    return false;
  }
  if (!isOpening()) placeEdited();  // the same place once more
  return isOpening();
}

void Workstation::undoEdit() {
  if (mayGoTo(history_.before())) goTo(history_.undo());
}

void Workstation::redoEdit() {
  if (mayGoTo(history_.after())) goTo(history_.redo());
}

bool Workstation::mayGoTo(const Scene* step) {
  if (!scene_ || !step) return false;
  Scene wanted = *step;
  keepCase(wanted, *scene_);
  const Status may = mayEdit(wanted);
  if (!may) fail(may.error());
  return may.ok();
}

void Workstation::goTo(Scene scene) {
  keepCase(scene, *scene_);
  (void)take(std::move(scene));
  emit sceneChanged();
  emit editsChanged();
}

Result<Scene> Workstation::asMade() const {
  if (one_set_ || scene_->tissues_elsewhere) return *scene_;
  Result<Scene> file = readScene(scene_file_);
  if (!file) return isElsewhere() ? file : *scene_;
  if (!file->tissues_elsewhere && !elsewhere_) return *scene_;
  Scene made = asEdited(*std::move(file));
  if (edited_other_) made.tissues = unplaced(*edited_other_);
  return made;
}

bool Workstation::isElsewhere() const {
  return case_ && std::ranges::any_of(case_->warnings, [](const Warning& warning) {
           return warning.code == "LACKS_STRUCTURE";
         });
}

bool Workstation::sceneEdited() const {
  if (!scene_) return false;
  Scene opened = withLiveOf(opened_scene_, *scene_);
  // Another case took the set for elsewhere, or an edit of the tissues did.
  if (!elsewhere_) opened.tissues_elsewhere = scene_->tissues_elsewhere;
  keepCase(opened, *scene_);
  for (Landmark& landmark : opened.landmarks) {  // of preparing a case
    const Landmark* now = scene_->findLandmarkById(landmark.id);
    if (now && isEntry(*now)) landmark = *now;
  }
  return !sameScene(opened, *scene_);
}

void Workstation::exerciseSaved(const std::filesystem::path& file) {
  const Result<Scene> saved = readScene(file);
  if (!scene_ || !saved) return;
  // What earlier steps named lies there no longer.
  const bool replaced = scene_file_ == file && !sameFiles(*scene_, *saved);
  scene_file_ = file;
  one_set_ = false;
  elsewhere_.reset();
  // Its files lie elsewhere now; numbers and the labels of this case stay.
  keepCase(*scene_, *saved);
  scene_->name = saved->name;
  scene_->operator_file = saved->operator_file;
  for (std::size_t i = 0; i < scene_->tools.size() && i < saved->tools.size(); ++i) {
    scene_->tools[i].look.mesh = saved->tools[i].look.mesh;
  }
  opened_scene_ = *scene_;
  declared_tissues_ = scene_->tissues;
  replaced ? history_.begin(*scene_) : history_.settle(*scene_);
  emit sceneChanged();
  emit editsChanged();
}

// What the file has, with what a person has changed of it since. Its case and its label map stay
// the file's: whether they hold is for useCase() to say.
Scene Workstation::asEdited(Scene file, bool another_case) const {
  if (!scene_) return file;
  Scene out = *scene_;
  keepCase(out, file);
  for (SceneArm& arm : out.arms) {  // a place is of one patient
    const auto same = std::ranges::find(file.arms, arm.name, &SceneArm::name);
    if (another_case && arm.map.fixed && same != file.arms.end()) arm.map = same->map;
  }
  for (Landmark& landmark : out.landmarks) {
    const Landmark* of_file = file.findLandmarkById(landmark.id);
    if (another_case && of_file && isEntry(landmark)) landmark = *of_file;
  }
  if (opened_scene_.outline == scene_->outline) out.outline = file.outline;
  out.tissues = file.tissues;
  out.tissues_elsewhere = file.tissues_elsewhere;
  if (one_set_) out.tissues_elsewhere.reset();
  if (elsewhere_) out.tissues_elsewhere = elsewhere_;
  if (!tissuesEdited()) return out;
  const bool of_elsewhere =
      !one_set_ && file.tissues_elsewhere && !scene_->tissues_elsewhere.has_value();
  (of_elsewhere ? *out.tissues_elsewhere : out.tissues) = unplaced(scene_->tissues);
  return out;
}

}  // namespace trephine
