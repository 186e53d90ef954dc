// Edits of the exercise by a person, and the way back.
#include <algorithm>

#include "session/arm_devices.h"
#include "tissue/tissue_edits.h"
#include "ui/common/words.h"
#include "ui/work/workstation.h"

namespace trephine {

namespace {

bool sameStructures(const TissueSet& a, const TissueSet& b) {
  return std::ranges::equal(a.tissues, b.tissues, [](const Tissue& one, const Tissue& other) {
    return one.id == other.id && one.structure == other.structure && one.shell == other.shell;
  });
}

bool samePlaces(const Scene& a, const Scene& b) {
  const bool both = a.tissues_elsewhere && b.tissues_elsewhere;
  // Whether the case is one for the anatomy is said with its places.
  return a.landmarks == b.landmarks && a.structures == b.structures && a.anatomy == b.anatomy &&
         sameStructures(a.tissues, b.tissues) &&
         a.tissues_elsewhere.has_value() == b.tissues_elsewhere.has_value() &&
         (!both || sameStructures(*a.tissues_elsewhere, *b.tissues_elsewhere));
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

// What can be changed while an exercise runs made the same.
Scene Workstation::withLiveOf(Scene scene, const Scene& other) const {
  tissuesOf(scene) = tissuesOf(other);
  scene.controller = other.controller;
  return scene;
}

// After an edit: what is drawn and felt follows at once.
void Workstation::refreshPlaced() {
  if (!placed_) return;
  placed_->scene = placedScene(onCase(*scene_, placed_->patient.source), *placed_);
}

NewTissues Workstation::withTissues(const TissueSet& set) const {
  Scene made = *scene_;
  const bool swapped = isElsewhere() && made.tissues_elsewhere;
  if (swapped) std::swap(made.tissues, *made.tissues_elsewhere);
  NewTissues out = trephine::withTissues(std::move(made), set);
  if (swapped && out.scene.tissues_elsewhere) {
    std::swap(out.scene.tissues, *out.scene.tissues_elsewhere);
  }
  return out;
}

Status Workstation::mayEdit(const Scene& wanted) const {
  if (tissuesOf(wanted) != tissues()) {
    if (Status may = notLocked(Lock::tissues, "The tissues are"); !may) return may;
  }
  const auto id = &Tissue::id;
  if (session_ && !std::ranges::equal(tissuesOf(wanted).tissues, tissues().tissues, {}, id, id)) {
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
  const bool places_alone = rest == *scene_;
  if (places_alone && withLiveOf(wanted, *scene_) == *scene_) return {};
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
  tissuesOf(wanted) = tissues;
  if (Status done = edit(wanted, what); !done) {
    fail(done.error());
    emit sceneChanged();  // as it was
  }
}

// True where more than tissues and controller changed.
bool Workstation::take(Scene wanted) {
  const bool places_stay = samePlaces(wanted, *scene_);
  const bool devices_stay = sameDevices(wanted, *scene_);
  const bool live_alone = withLiveOf(wanted, *scene_) == *scene_;
  const bool new_set = tissuesOf(wanted) != tissues();
  const bool new_controller = wanted.controller != scene_->controller;
  const ControllerKind controller = wanted.controller;
  scene_ = std::move(wanted);
  refreshPlaced();
  if (!devices_stay) readArms();
  if (new_set) tellTissues();
  if (new_controller) {
    applyController(controller);
    emit controllerChanged();
  }
  if (!places_stay && placed_ && phase_ == Phase::ready) placeEdited();
  return !live_alone;
}

// What is edited while that goes on is placed after it.
void Workstation::placeEdited() {
  place_again_ = isOpening();
  if (place_again_) return;
  placeAgain(placed_->patient.structures);
  placing_edit_ = true;
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
  if (!placed_ || phase_ != Phase::ready || isOpening()) return false;
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
  const Status may = mayEdit(*step);
  if (!may) fail(may.error());
  return may.ok();
}

void Workstation::goTo(Scene scene) {
  (void)take(std::move(scene));
  emit sceneChanged();
  emit editsChanged();
}

bool Workstation::sceneEdited() const {
  if (!scene_) return false;
  Scene opened = withLiveOf(opened_scene_, *scene_);
  for (Landmark& landmark : opened.landmarks) {  // of preparing a case
    const Landmark* now = scene_->findLandmarkById(landmark.id);
    if (now && isEntry(*now)) landmark = *now;
  }
  return opened != *scene_;
}

void Workstation::exerciseSaved(const std::filesystem::path& file) {
  const Result<Scene> saved = readScene(file);
  if (!scene_ || !saved) return;
  // What earlier steps named lies there no longer.
  const bool replaced = scene_file_ == file && !sameFiles(*scene_, *saved);
  scene_file_ = file;
  // The open case is its own now, and its files lie elsewhere.
  scene_->case_source = saved->case_source;
  scene_->labels_file = saved->labels_file;
  scene_->outline = saved->outline;
  scene_->name = saved->name;
  scene_->operator_file = saved->operator_file;
  for (std::size_t i = 0; i < scene_->tools.size() && i < saved->tools.size(); ++i) {
    scene_->tools[i].look.mesh = saved->tools[i].look.mesh;
  }
  opened_scene_ = *scene_;
  if (placed_) placed_->patient.source = saved->case_source;
  refreshPlaced();
  replaced ? history_.begin(*scene_) : history_.settle(*scene_);
  emit sceneChanged();
  emit editsChanged();
}

// Places in one patient go: they are again where the exercise was opened with them.
Scene Workstation::forAnotherCase(Scene scene) const {
  for (SceneArm& arm : scene.arms) {
    const auto same = std::ranges::find(opened_scene_.arms, arm.name, &SceneArm::name);
    if (arm.map.fixed && same != opened_scene_.arms.end()) arm.map = same->map;
  }
  for (Landmark& landmark : scene.landmarks) {
    if (isEntry(landmark)) landmark = *opened_scene_.findLandmarkById(landmark.id);
  }
  return scene;
}

}  // namespace trephine
