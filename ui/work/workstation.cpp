#include "ui/work/workstation.h"

#include <QDateTime>
#include <algorithm>
#include <chrono>

#include "base/file.h"
#include "base/memory.h"
#include "base/rt/thread.h"
#include "library/name_words.h"
#include "session/arm_devices.h"
#include "ui/common/settings.h"
#include "ui/common/words.h"
#include "volume/case_memory.h"

namespace trephine {

namespace {

// Arms are opened by one at a time; who wants none of them need not wait.
Status armsAreFree(std::unique_lock<std::timed_mutex>& lock, const Rig& rig,
                   const ArmsOfPlace& chosen) {
  const auto is_real = [](const Rig::Arm& arm) { return arm.device.plugin != kSimulated; };
  if (chosen.empty() && std::ranges::none_of(rig.arms, is_real)) return {};
  if (lock.try_lock_for(std::chrono::seconds(10))) return {};
  return Error{
      "ARMS_BUSY", "Looking for arms has not come to an end: a device does not answer", "",
      "Unplug it and wait, or start Trephine again; mouse and keys move hands that have no "
      "arm under Devices"};
}

}  // namespace

Workstation::Workstation(const Policy& policy, QObject* parent) : QObject(parent), policy_(policy) {
  connect(&opening_, &BackgroundTask::progressed, this, &Workstation::openingProgressed);
  connect(&opening_, &BackgroundTask::ended, this, &Workstation::openingEnded);
  connect(&opening_, &BackgroundTask::began, this, &Workstation::phaseChanged);
  connect(&opening_, &BackgroundTask::ended, this, &Workstation::phaseChanged);
  // Once the outcome of this one is taken.
  connect(
      &opening_, &BackgroundTask::ended, this,
      [this] {
        if (std::exchange(place_again_, false) && placed_ && phase_ == Phase::ready) placeEdited();
      },
      Qt::QueuedConnection);
  connect(&import_, &ImportTask::failed, this, &Workstation::failed);
  connect(&saving_, &BackgroundTask::progressed, this, &Workstation::savingProgressed);
  connect(&saving_, &BackgroundTask::ended, this, &Workstation::savingEnded);
}

Workstation::~Workstation() = default;

void Workstation::setPhase(Phase phase) {
  phase_ = phase;
  emit phaseChanged();
}

void Workstation::fail(const Error& error) {
  if (error.code != "CANCELLED") emit failed(error);
}

// --- The exercise ---

void Workstation::start(const std::filesystem::path& recordings,
                        std::optional<OperatorScript> script, double seconds) {
  begin(recordings, std::move(script), seconds, false);
}

void Workstation::poke() {
  constexpr double kNoEnd_s = 1e9;
  begin({}, {}, kNoEnd_s, true);
}

void Workstation::begin(const std::filesystem::path& recordings,
                        std::optional<OperatorScript> script, double seconds, bool poke) {
  if (phase_ != Phase::ready || isOpening()) return;
  // It may have come in while it was unlocked.
  if (Status may = mayPractise(*scene_, scene_file_); !may) return fail(may.error());
  Scene practised = onCase(*scene_, placed_->patient.source);
  ArmsOfPlace chosen;
  if (!arms_) {
    practised = withForceLimit(std::move(practised));
    chosen = armsOfThisPlace();
  }
  Result<Rig> rig = rigWith(practised, arms_.value_or(std::vector<NamedDevice>()), {});
  if (!rig) return fail(rig.error());
  setPhase(Phase::starting);
  // The name is the time: nothing of the patient, nothing of the folder.
  const std::string stem =
      QDateTime::currentDateTime().toString("'session'-yyyyMMdd-HHmmss").toStdString();
  carved_.reset();  // its memory is the next one's
  // What was found in tissues that have been edited since lies elsewhere now, or is found now.
  const TissueTable tissues = tissueTable(placedTissues());
  const bool again = placed_->error || !(placed_with_ == tissues);
  running_.run(
      [scene = std::move(practised), rig = *std::move(rig), chosen, opens = opens_arms_,
       placed = *placed_, again, recordings, stem, poke, script = std::move(script)](
          const Progress& progress) mutable -> Result<std::unique_ptr<Session>> {
        std::unique_lock lock(*opens, std::defer_lock);
        if (Status had = armsAreFree(lock, rig, chosen); !had) return had.error();
        Result<Rig> used = chosen.empty() ? Result<Rig>(std::move(rig)) : rigOf(scene, chosen);
        if (!used) return used.error();
        if (Status made = poke ? Status() : makeFolder(recordings); !made) return made.error();
        if (!again) {
          placed.scene = placedScene(scene, placed);
        } else {
          Result<Placement> anew = place(scene, placed.patient, progress, hideNamesOf);
          if (!anew) return anew.error();
          placed = *std::move(anew);
        }
        const auto file = poke ? std::filesystem::path() : freshFile(recordings, stem, ".h5");
        return Session::create(placed, {file, script, true, poke, nullptr, *std::move(used)});
      },
      [this, seconds, tissues](Result<std::unique_ptr<Session>> created) {
        if (!created) return notStarted(created.error());
        placed_->landmarks = (*created)->landmarks();
        placed_->error.reset();
        refreshPlaced();
        placed_with_ = tissues;
        startArms(*std::move(created), seconds);
      });
}

// Devices may take their time over it.
void Workstation::startArms(std::unique_ptr<Session> session, double seconds) {
  // What was changed while the session was made is the first thing that it is told.
  ControllerKind told_of = session->scene().controller;
  if (Status told = tell(*session, told_of); !told) return notStarted(told.error());
  running_.run(
      [session = std::move(session), seconds,
       stepped = stepped_](const Progress&) mutable -> Result<std::unique_ptr<Session>> {
        const Status started = stepped ? session->startStepped(seconds) : session->start(seconds);
        if (!started) return started.error();
        return std::move(session);
      },
      [this, told_of](Result<std::unique_ptr<Session>> started) mutable {
        if (!started) return notStarted(started.error());
        if (Status told = tell(**started, told_of); !told) return notStarted(told.error());
        this->started(*std::move(started));
      });
}

// Tissues and controller as they are by now; `told_of`: the controller that it knows of.
Status Workstation::tell(Session& session, ControllerKind& told_of) const {
  if (Status told = session.setTissues(placedTissues()); !told) return told;
  if (told_of != scene_->controller) {
    (void)session.setController(scene_->controller);  // nothing else waits yet
    told_of = scene_->controller;
  }
  return {};
}

void Workstation::started(std::unique_ptr<Session> session) {
  session_ = std::move(session);
  recording_failure_.reset();
  setPhase(Phase::running);
  emit sessionStarted();
}

void Workstation::notStarted(const Error& error) {
  setPhase(Phase::ready);
  tellGivenBack();
  emit startFailed();
  fail(error);
}

// What the case that is open leaves to the next, and what need not be taken again.
void Workstation::tellGivenBack() {
  if (!placed_) return;
  const std::size_t voxels = placed_->patient.volume->geometry.voxelCount();
  import_.setGivenBack(voxelsMb(voxels) * (carved_ ? 2.0 : 1.0) + shownMb(voxels) +
                       (rt::LockedMemory::wasHeld() ? kHeld_mb : 0.0));
}

void Workstation::lendArms(bool lent) {
  lent_ = lent;
  if (!lent && scene_) readArms();
}

// As simulated, at once, and then as chosen. An arm that is not there now may be when the exercise
// starts, which then says so.
void Workstation::readArms() {
  rig_ = simulatedRig(*scene_);
  if (!readArmDynamics(*scene_, rig_, &workspaces_mm_)) workspaces_mm_.clear();
  emit armsAnswered();
  askArms();
}

void Workstation::askArms() {
  const ArmsOfPlace chosen = arms_ ? ArmsOfPlace() : armsOfThisPlace();
  const bool free = phase_ == Phase::ready || phase_ == Phase::empty;
  if (!scene_ || !free || lent_) return;
  if (chosen.empty()) return;
  if (asking_.busy()) {
    ask_again_ = true;
    return;
  }
  asking_.run(
      [scene = *scene_, chosen,
       opens = opens_arms_](const Progress&) -> Result<std::pair<Rig, std::vector<Vec3>>> {
        std::unique_lock lock(*opens, std::defer_lock);
        if (Status had = armsAreFree(lock, {}, chosen); !had) return had.error();
        Result<Rig> rig = rigOf(scene, chosen);
        if (!rig) return rig.error();
        std::vector<Vec3> workspaces_mm;
        if (Status asked = readArmDynamics(scene, *rig, &workspaces_mm); !asked) {
          return asked.error();
        }
        return std::pair(*std::move(rig), std::move(workspaces_mm));
      },
      [this, arms = scene_->arms](Result<std::pair<Rig, std::vector<Vec3>>> asked) {
        if (std::exchange(ask_again_, false)) return askArms();
        const auto name = &SceneArm::name;
        if (!asked || !scene_ || !std::ranges::equal(arms, scene_->arms, {}, name, name)) return;
        rig_ = std::move(asked->first);
        workspaces_mm_ = std::move(asked->second);
        emit armsAnswered();
      });
}

void Workstation::checkRecording() {
  if (!session() || recording_failure_) return;
  const Status recording = session_->recordingStatus();
  if (recording) return;
  recording_failure_ = recording.error();
  emit recordingFailed(*recording_failure_);
}

void Workstation::stop() {
  if (phase_ != Phase::running) return;
  setPhase(Phase::ending);  // from here to the outcome the session is the background thread's
  running_.run([session = session_.get()](const Progress&) { return session->stop(); },
               [this](Status stopped) {
                 const bool poke = session_->isPoke();
                 if (!poke) carved_ = session_->carved();
                 tellGivenBack();
                 emit sessionEnded(*session_);
                 if (!poke) emit exerciseReported(session_->report());
                 const std::optional<Error> stuck = session_->leftBehind();
                 session_.reset();
                 noteController(scene_->controller);
                 setPhase(Phase::ready);
                 const bool said = !stopped && recording_failure_ &&
                                   recording_failure_->what == stopped.error().what;
                 if (!stopped && !said) fail(stopped.error());
                 if (stuck) fail(*stuck);
               });
}

}  // namespace trephine
