// What a trainee may not change, and the changes that ask first.
#include "ui/common/words.h"
#include "ui/work/workstation.h"

namespace trephine {

bool Workstation::isLocked(Lock lock) const {
  if (unlocked_) return false;
  return scene_ ? locksOf(policy_, *scene_).contains(lock) : policy_.isLocked(lock);
}

bool Workstation::tissuesWouldGo() const {
  return unlocked_ && scene_ && tissuesEdited() &&
         locksOf(policy_, *scene_).contains(Lock::tissues);
}

bool Workstation::anyLocked() const {
  return isLocked(Lock::controller) || isLocked(Lock::tissues) || isLocked(Lock::rate);
}

void Workstation::setUnlocked(bool unlocked) {
  unlocked_ = unlocked;
  if (!unlocked && scene_) takeBack();
  emit locksChanged();
}

// What was changed while it was unlocked: controller and tissues are what they are prescribed to
// be, or what the exercise brings. A rate of another scene is seen to when that is started.
void Workstation::takeBack() {
  if (isLocked(Lock::tissues) && tissuesEdited()) {
    tissuesOf(*scene_) = declaredTissues();
    refreshPlaced();
    tellTissues();
    history_.begin(*scene_);
    emit sceneChanged();
    emit editsChanged();
  }
  if (!isLocked(Lock::controller)) return;
  applyController(policy_.controller.value_or(opened_scene_.controller));
  emit controllerChanged();
}

Status Workstation::notLocked(Lock lock, const char* what) const {
  if (!isLocked(lock)) return {};
  return Error{"LOCKED", std::string(what) + " locked on this workstation or by this exercise", "",
               unlockWords(policy_).toStdString()};
}

bool Workstation::refuseLocked(Lock lock, const char* what) {
  const Status may = notLocked(lock, what);
  if (!may) fail(may.error());
  return !may.ok();
}

void Workstation::tellTissues() {
  if (!session()) return;
  if (Status set = session_->setTissues(placedTissues()); !set) fail(set.error());
}

void Workstation::noteController(ControllerKind in_force) {
  if (std::exchange(in_force_, in_force) != in_force) emit controllerChanged();
}

void Workstation::setController(ControllerKind kind) {
  if (!scene_) return;
  if (kind != scene_->controller && refuseLocked(Lock::controller, "The controller is")) {
    return emit controllerChanged();
  }
  applyController(kind);
}

void Workstation::applyController(ControllerKind kind) {
  scene_->controller = kind;
  refreshPlaced();
  history_.settle(*scene_);
  if (!session()) noteController(kind);
  if (session() && !session_->setController(kind)) {
    fail({"BUSY", "Too many changes are waiting", "the haptic loop", "Try again"});
  }
}

}  // namespace trephine
