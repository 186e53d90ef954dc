#include "desk/desk.h"

#include <algorithm>

#include "base/codes.h"
#include "base/file.h"
#include "base/local_time.h"
#include "base/memory.h"
#include "base/rt/thread.h"
#include "library/name_words.h"
#include "session/arm_devices.h"
#include "volume/case_memory.h"

namespace trephine {

Desk::Desk(const Policy& policy, DeskEvents& events, std::function<ArmSettings()> settings,
           std::function<void()> wake)
    : policy_(policy),
      events_(events),
      settings_(std::move(settings)),
      arms_here_([this] { return armsToAsk(); }, [this] { say(DeskChange::arms); }, wake),
      opening_(wake),
      running_(wake),
      saving_(wake) {
  opening_.progressed = [this](double fraction, const std::string& step) {
    events_.onOpeningProgress(fraction, step);
  };
  opening_.ended = [this] { endOpening(); };
  saving_.progressed = [this](double fraction, const std::string& step) {
    events_.onSavingProgress(fraction, step);
  };
  saving_.ended = [this] { say(DeskChange::saving_ended); };
}

Desk::~Desk() = default;

void Desk::take() {
  arms_here_.take();
  opening_.take();
  running_.take();
  saving_.take();
  if (std::exchange(ended_.place_again, false) && phase() == Phase::ready) placeEdited();
  if (waiting_save_ && std::chrono::steady_clock::now() >= waiting_save_->again) {
    saveOnceStill(*std::exchange(waiting_save_, {}));
  }
}

Desk::Phase Desk::phase() const {
  if (std::holds_alternative<Starting>(activity_)) return Phase::starting;
  if (std::holds_alternative<Running>(activity_)) return Phase::running;
  if (std::holds_alternative<Ending>(activity_)) return Phase::ending;
  return placed_ ? Phase::ready : Phase::empty;
}

void Desk::go(Activity activity) {
  activity_ = std::move(activity);
  say(DeskChange::phase);
}

void Desk::fail(const Error& error) {
  if (error.code != code::kCancelled) events_.onFailure(error);
}

Session* Desk::heldSession() const {
  if (const auto* running = std::get_if<Running>(&activity_)) return running->session.get();
  if (const auto* ending = std::get_if<Ending>(&activity_)) return ending->session.get();
  return nullptr;
}

std::optional<LandmarkFrame> Desk::viewLandmark() const {
  if (!placed_) return {};
  for (const PlacedLandmark& landmark : placed_->landmarks) {
    if (exercise_ && landmark.id == exercise_->view.landmark) return landmark.frame;
  }
  return {};
}

double Desk::givenBack_mb() const {
  if (!placed_) return 0.0;
  const std::size_t voxels = placed_->patient.volume->geometry.voxelCount();
  return voxelsMb(voxels) * (carved_ ? 2.0 : 1.0) + shownMb(voxels) +
         (rt::LockedMemory::wasHeld() ? kHeld_mb : 0.0);
}

// --- Arms ---

void Desk::lendArms(bool lent) {
  arms_lent_ = lent;
  if (!lent && exercise_) arms_here_.read(*exercise_);
}

std::optional<ChosenArms> Desk::armsToAsk() const {
  const bool free = phase() == Phase::ready || phase() == Phase::empty;
  if (!exercise_ || !free || arms_lent_) return {};
  return arms_ ? ChosenArms() : settings_().chosen;
}

// --- The session ---

void Desk::start(const std::filesystem::path& recordings, std::optional<OperatorScript> script,
                 double seconds) {
  begin(recordings, std::move(script), seconds, false);
}

void Desk::poke() {
  constexpr double kNoEnd_s = 1e9;
  begin({}, {}, kNoEnd_s, true);
}

void Desk::begin(const std::filesystem::path& recordings, std::optional<OperatorScript> script,
                 double seconds, bool poke) {
  if (phase() != Phase::ready || isOpening()) return;
  // It may have come in while it was unlocked.
  if (Status may = mayPractise(*exercise_, exercise_file_); !may) return fail(may.error());
  if (Status kept = poke ? Status() : keptAsSaved(); !kept) return fail(kept.error());
  practised_ = practising_ && !poke;
  Exercise practised = onCase(*exercise_, placed_->patient.source);
  ChosenArms chosen;
  if (!arms_) {
    ArmSettings settings = settings_();
    practised = withForceLimit(std::move(practised), settings.most_N);
    chosen = std::move(settings.chosen);
  }
  Result<Rig> rig = rigWith(practised, arms_.value_or(std::vector<NamedDevice>()), {});
  if (!rig) return fail(rig.error());
  go(Starting{});
  // The name is the time: nothing of the patient, nothing of the folder.
  const std::string stem = localTime("session-%Y%m%d-%H%M%S");
  carved_.reset();  // its memory is the next one's
  question_.reset();
  // What was found in tissues that have been edited since lies elsewhere now, or is found now.
  const TissueTable tissues = tissueTable(placedTissues());
  const bool again = placed_->error || !(placed_with_ == tissues);
  running_.run(
      [exercise = std::move(practised), rig = *std::move(rig), chosen, opens = opensArms(),
       placed = *placed_, again, recordings, stem, poke, script = std::move(script)](
          const Progress& progress) mutable -> Result<std::unique_ptr<Session>> {
        std::unique_lock lock(*opens, std::defer_lock);
        if (Status free = waitForArms(lock, rig, chosen); !free) return free.error();
        Result<Rig> used = chosen.empty() ? Result<Rig>(std::move(rig)) : rigOf(exercise, chosen);
        if (!used) return used.error();
        if (Status made = poke ? Status() : makeFolder(recordings); !made) return made.error();
        if (!again) {
          placed.exercise = placedExercise(exercise, placed);
        } else {
          Result<Placement> anew = place(exercise, placed.patient, progress, hideNamesOf);
          if (!anew) return anew.error();
          placed = *std::move(anew);
        }
        const auto file = poke ? std::filesystem::path() : freshFile(recordings, stem, ".h5");
        return Session::create(placed, {file, script, true, poke, nullptr, {}, *std::move(used)});
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
void Desk::startArms(std::unique_ptr<Session> session, double seconds) {
  // What was changed while the session was made is the first thing that it is told.
  ControllerKind told_of = session->exercise().controller;
  if (Status told = tell(*session, told_of); !told) return notStarted(told.error());
  running_.run(
      [session = std::move(session), seconds,
       stepped = stepped_](const Progress&) mutable -> Result<std::unique_ptr<Session>> {
        const Status begun = stepped ? session->startStepped(seconds) : session->start(seconds);
        if (!begun) return begun.error();
        return std::move(session);
      },
      [this, told_of](Result<std::unique_ptr<Session>> begun) mutable {
        if (!begun) return notStarted(begun.error());
        if (Status told = tell(**begun, told_of); !told) return notStarted(told.error());
        go(Running{*std::move(begun), {}});
        say(DeskChange::session_started);
      });
}

// Tissues and controller as they are by now; `told_of`: the controller that it knows of.
Status Desk::tell(Session& session, ControllerKind& told_of) const {
  if (Status told = session.setTissues(placedTissues()); !told) return told;
  if (told_of != exercise_->controller) {
    (void)session.setController(exercise_->controller);  // nothing else waits yet
    told_of = exercise_->controller;
  }
  return {};
}

void Desk::notStarted(const Error& error) {
  go(Idle{});
  say(DeskChange::start_failed);
  fail(error);
}

void Desk::checkRecording() {
  auto* running = std::get_if<Running>(&activity_);
  if (!running || running->recording_failure) return;
  const Status recording = running->session->recordingStatus();
  if (recording) return;
  running->recording_failure = recording.error();
  events_.onRecordingFailed(recording.error());
}

void Desk::stop() {
  auto* running = std::get_if<Running>(&activity_);
  if (!running) return;
  Session* session = running->session.get();
  // From here to the outcome the session is the background thread's.
  go(Ending{std::move(running->session), std::move(running->recording_failure)});
  running_.run([session](const Progress&) { return session->stop(); },
               [this](const Status& status) { stopped(status); });
}

void Desk::stopped(const Status& status) {
  Session& session = *heldSession();
  const std::optional<Error> said = std::get<Ending>(activity_).recording_failure;
  const bool poke = session.isPoke();
  if (!poke) carved_ = session.carved();
  events_.onSessionEnded(session);
  if (!poke) events_.onReport(session.report());
  const std::optional<Error> stuck = session.leftBehind();
  std::get<Ending>(activity_).session.reset();
  giveBackFreedMemory();
  noteController(exercise_->controller);
  go(Idle{});
  // In Prepare they held only for what ran.
  if (std::exchange(practised_, false) && !opened_exercise_.locks.empty()) say(DeskChange::locks);
  if (!status && !(said && said->what == status.error().what)) fail(status.error());
  if (stuck) fail(*stuck);
}

}  // namespace trephine
