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
  scene.tissues_elsewhere = other.tissues_elsewhere;
  scene.controller = other.controller;
  return scene;
}

// Where it lies: the case's, not a person's.
void keepCase(Scene& scene, const Scene& of) {
  scene.case_source = of.case_source;
  scene.labels_file = of.labels_file;
}

bool samePlaces(const Scene& a, const Scene& b) {
  const auto places = [](const Scene& scene) {
    Json json = toJson(scene).at("landmarks");
    json.push_back(scene.structures);
    for (const Tissue& t : scene.tissues.tissues) {
      json.push_back({t.id, t.structure, t.shell ? t.shell->of : "",
                      t.shell ? t.shell->thickness_mm : 0.0});
    }
    return json;
  };
  return places(a) == places(b);
}

bool sameLandmark(const Landmark& a, const Landmark& b) {
  const auto whole = [](const Landmark& landmark) {
    Scene scene;
    scene.landmarks = {landmark};
    return toJson(scene).at("landmarks");
  };
  return whole(a) == whole(b);
}

bool sameDevices(const Scene& a, const Scene& b) {
  return std::ranges::equal(a.arms, b.arms, [](const SceneArm& one, const SceneArm& other) {
    return one.plugin == other.plugin && one.device_arm == other.device_arm &&
           one.device_config == other.device_config;
  });
}

}  // namespace

bool Workstation::mayEdit(const Scene& wanted) {
  if (!sameSet(wanted.tissues, scene_->tissues) &&
      refuseLocked(Lock::tissues, "The tissues are")) {
    return false;
  }
  const auto id = &Tissue::id;
  if (session_ && !std::ranges::equal(wanted.tissues.tissues, scene_->tissues.tissues, {}, id, id)) {
    fail({"BUSY", "A running exercise keeps its list of tissues", "",
          "Stop it before tissues are added or removed"});
    return false;
  }
  if (wanted.controller != scene_->controller &&
      refuseLocked(Lock::controller, "The controller is")) {
    return false;
  }
  if (wanted.rate_hz != scene_->rate_hz && refuseLocked(Lock::rate, "The rate is")) return false;
  // Where an exercise enters a patient is of preparing a case.
  Scene rest = withLiveOf(wanted, *scene_);
  rest.landmarks = scene_->landmarks;
  const bool places_alone = sameScene(rest, *scene_);
  if (places_alone && sameScene(withLiveOf(wanted, *scene_), *scene_)) return true;
  if (anyLocked() && !places_alone) {
    fail({"LOCKED", "Exercises are not changed while anything is locked", "",
          unlockWords(policy_).toStdString()});
    return false;
  }
  if (phase_ != Phase::ready && phase_ != Phase::empty) {
    fail({"BUSY", "This cannot be changed while an exercise runs", "", "Stop it first"});
    return false;
  }
  if (isOpening() && !placing_) {
    fail({"BUSY", "A case is being opened", "", "Try again in a moment"});
    return false;
  }
  return true;
}

bool Workstation::edit(const Scene& wanted, const std::string& what) {
  if (!scene_) return false;
  if (!mayEdit(wanted)) {
    emit sceneChanged();  // as it was
    return false;
  }
  history_.note(wanted, what);
  take(wanted);
  emit editsChanged();
  return true;
}

void Workstation::setTissues(const TissueSet& tissues, const std::string& what) {
  if (!scene_) return;
  Scene wanted = *scene_;
  wanted.tissues = tissues;
  (void)edit(wanted, what);
}

void Workstation::take(Scene wanted) {
  const LabelMap* labels = case_ ? case_->labels.get() : nullptr;
  placeTissues(wanted.tissues, labels);
  const bool places_stay = samePlaces(wanted, *scene_);
  const bool devices_stay = sameDevices(wanted, *scene_);
  const bool live_alone = sameScene(withLiveOf(wanted, *scene_), *scene_);
  if (wanted.tissues_elsewhere.has_value() != scene_->tissues_elsewhere.has_value()) {
    one_set_ = !wanted.tissues_elsewhere;
  }
  const bool new_set = !sameSet(wanted.tissues, scene_->tissues);
  const bool new_controller = wanted.controller != scene_->controller;
  const ControllerKind controller = wanted.controller;
  scene_ = std::move(wanted);
  history_.settle(*scene_);
  if (!devices_stay) (void)readArmDynamics(*scene_);
  if (new_set) applyTissues(scene_->tissues);
  if (new_controller) {
    const ControllerKind opened = opened_scene_.controller;
    applyController(controller);
    opened_scene_.controller = opened;
    emit controllerChanged();
  }
  if (!live_alone) emit sceneChanged();
  if (!places_stay && case_ && phase_ == Phase::ready) placeEdited();
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
  return landmark.is_place && of_file && !sameLandmark(landmark, *of_file);
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
  if (!edit(wanted, "entry")) return false;
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
  return mayEdit(wanted);
}

void Workstation::goTo(Scene scene) {
  keepCase(scene, *scene_);
  take(std::move(scene));
  emit sceneChanged();
  emit editsChanged();
}

bool Workstation::sceneEdited() const {
  if (!scene_) return false;
  Scene opened = withLiveOf(opened_scene_, *scene_);
  keepCase(opened, *scene_);
  return !sameScene(opened, *scene_);
}

// What the file has, with what a person has changed of it since. Its case and its label map stay
// the file's: whether they hold is for useCase() to say.
Scene Workstation::asEdited(Scene file, bool another_case) const {
  if (!scene_) return file;
  Scene out = *scene_;
  keepCase(out, file);
  for (Landmark& landmark : out.landmarks) {  // a place is of one patient
    const Landmark* of_file = file.findLandmarkById(landmark.id);
    if (another_case && of_file && isEntry(landmark)) landmark = *of_file;
  }
  const auto outline = [](const Scene& scene) {
    return scene.outline ? toJson(*scene.outline) : Json();
  };
  if (outline(opened_scene_) == outline(*scene_)) out.outline = file.outline;
  out.tissues = file.tissues;
  out.tissues_elsewhere = file.tissues_elsewhere;
  if (one_set_) out.tissues_elsewhere.reset();
  if (!tissuesEdited()) return out;
  const bool of_elsewhere =
      !one_set_ && file.tissues_elsewhere && !scene_->tissues_elsewhere.has_value();
  (of_elsewhere ? *out.tissues_elsewhere : out.tissues) = unplaced(scene_->tissues);
  return out;
}

}  // namespace trephine
