#include "session/session.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <limits>
#include <new>
#include <system_error>

#include "base/codes.h"
#include "base/crash_report.h"
#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/rt/thread.h"
#include "base/system.h"
#include "base/tr.h"
#include "device/codes.h"
#include "session/arm_devices.h"
#include "session/codes.h"
#include "session/session_engine.h"
#include "volume/case_memory.h"

namespace trephine {

namespace {

using namespace std::chrono_literals;

constexpr int kHapticPriority = 80;
constexpr int kWatchdogPriority = 81;  // it must see what the haptic thread does not
// stop() answers within 0.5 s: so long it waits for the force to go, and then for the thread.
constexpr auto kSilencePatience = 50ms;
constexpr auto kStopPatience = 100ms;
// How the mouse holds a simulated arm: a firm but not a rigid hand.
constexpr double kMouseStiffness_N_per_m = 600.0;
constexpr double kMouseDamping_Ns_per_m = 4.0;

// Such a tissue is nowhere: a wrong number, or another label map.
void warnOfAbsentLabels(const TissueSet& tissues, const LabelMap* labels) {
  if (!labels) return;
  for (const Tissue& tissue : tissues.tissues) {
    if (!tissue.label || !tissue.structure.empty()) continue;
    const auto& all = labels->labels;
    if (std::find(all.begin(), all.end(), std::uint8_t(*tissue.label)) == all.end()) {
      spdlog::warn("No voxel of the case has the label {} of '{}'", *tissue.label, tissue.id);
    }
  }
}

// Writes into the log what the meter, which takes each event before it, warns of.
class WarningLog : public RecordSink {
 public:
  explicit WarningLog(const RunMeter& meter) : meter_(meter) {}
  void event(const Event&) override {
    const std::vector<Warning>& warnings = meter_.metrics().warnings;
    for (; logged_ < warnings.size(); ++logged_) spdlog::warn("{}", warnings[logged_].text);
  }

 private:
  const RunMeter& meter_;
  std::size_t logged_ = 0;
};

}  // namespace

std::filesystem::path freshFile(const std::filesystem::path& folder, const std::string& stem,
                                const std::string& extension) {
  std::filesystem::path file = folder / (stem + extension);
  std::error_code ec;
  for (int number = 2; std::filesystem::exists(file, ec); ++number) {
    file = folder / (stem + "-" + std::to_string(number) + extension);
  }
  return file;
}

Result<std::unique_ptr<Session>> Session::create(const Placement& placed,
                                                 const SessionOptions& options) {
  std::unique_ptr<Session> session(new Session);
  try {
    if (Status set = session->set(placed, options); !set) return set.error();
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("for the exercise"), tr("the case"));
  }
  return session;
}

Status Session::set(const Placement& placed, const SessionOptions& options) {
  if (placed.error) return *placed.error;
  const Case& of = placed.patient;
  const Volume& volume = *of.volume;
  if (volume.geometry.voxelCount() > std::numeric_limits<std::uint32_t>::max()) {
    return Error{code::kTooLarge, tr("The case has more than 2^32 voxels"), tr("the case"),
                 tr("Crop it or export it at a lower resolution")};
  }
  if (Status known = checkLabels(placed.exercise.tissues, placed.labels.get());
      !known) return known;
  for (const Warning& warning : placed.warnings) {
    warnings_.push_back(warning);
    spdlog::warn("{}", warning.text);
  }
  landmarks_ = placed.landmarks;
  exercise_ = placed.exercise;
  if (options.poke) {
    poke_curves_ = std::make_unique<PokeCurves>(exercise_.arms.size(), exercise_.rate_hz);
    sinks_.push_back(poke_curves_.get());
  }
  meter_ = std::make_unique<RunMeter>(exercise_);
  sinks_.push_back(meter_.get());
  warning_log_ = std::make_unique<WarningLog>(*meter_);
  sinks_.push_back(warning_log_.get());

  std::vector<LoopDevice> devices;
  rig_ = options.rig;
  addSimulatedArms(rig_, exercise_.arms.size());
  if (Status opened = openDevices(exercise_, rig_, devices, capabilities_); !opened) return opened;

  const double needed_mb = exerciseMb(volume.geometry.voxelCount(), rt::LockedMemory::wasHeld());
  if (Status enough = enoughMemory(needed_mb, tr("The exercise"), tr("the case")); !enough)
    return enough;
  sha256_before_ = of.sha256;
  before_ = of.volume;
  structures_ = of.structures;
  grid_ = std::make_shared<Grid>(Volume(volume), placed.labels);
  warnOfAbsentLabels(placed.exercise.tissues, placed.labels.get());
  for (const BoundedTissue& b : boundedTissues(exercise_, rig_)) {
    spdlog::warn("'{}' is firmer than the {} arm shows: of {:.4g} N s/m and {:.4g} N/m, {:.4g} and "
                 "{:.4g} are felt",
                 b.tissue, b.arm, b.demanded.damping, b.demanded.stiffness, b.felt.damping,
                 b.felt.stiffness);
  }
  HapticParameters parameters = hapticParameters(exercise_, rig_);
  parameters.removes = !options.poke;
  core_ = std::make_unique<HapticCore>(parameters, *grid_->takeWriter());
  const std::filesystem::path beside = options.recording.parent_path();
  const Result<std::filesystem::path> journal_folder = beside.empty() ? temporaryFolder() : beside;
  if (!journal_folder) return journal_folder.error();
  Result<std::unique_ptr<JournalFile>> journal_file = JournalFile::create(*journal_folder);
  if (!journal_file) return journal_file.error();
  journal_file_ = *std::move(journal_file);
  std::unique_ptr<Operator> script;
  if (options.script) {
    script =
        std::make_unique<ScriptOperator>(*options.script, exercise_, armFrames(exercise_, landmarks_));
  }
  for (LiveHands::Hand& hand : hands_.hands) {
    hand = {};
    hand.stiffness_N_per_m = kMouseStiffness_N_per_m;
    hand.damping_Ns_per_m = kMouseDamping_Ns_per_m;
  }
  engine_ = std::make_shared<Engine>(*core_, std::move(devices), std::move(script));
  engine_->live_hands.write(hands_);
  loop_ = &engine_->loop;
  loop_->setProbe(options.probe);
  for (const LoopDevice& d : loop_->devices()) {
    for (std::size_t i : d.arms) simulated_[i] = d.device->takesTargets();
  }
  for (std::size_t i = 0; i < exercise_.arms.size(); ++i) {
    const double* size_m = capabilities_[i].workspace_m;
    engine_->oper.setReach(i, {exercise_.arms[i].max_force_N, {size_m[0], size_m[1], size_m[2]}});
  }
  if (options.hands_outside && !options.script) beginOutside();

  if (!options.recording.empty()) {
    recording_file_ = options.recording;
    const RecordingHeader header{toJson(RecordedExercise{exercise_, rig_}), sha256_before_, grid_->geometry(), buildName(),
                                 placed.labels ? labelsSha256(*placed.labels) : ""};
    Result<std::unique_ptr<SessionRecorder>> recorder =
        SessionRecorder::create(options.recording, header, exercise_.arms.size());
    if (!recorder) return recorder.error();
    recorder_ = *std::move(recorder);
    sinks_.push_back(recorder_.get());
  }
  std::ranges::copy(options.sinks, std::back_inserter(sinks_));
  return {};
}

Session::~Session() {
  if (running_) (void)stop();
  if (recorder_ && !recording_ended_) (void)finishRecording();  // it never came to a tick
}

Status Session::start(double seconds) {
  if (Status started = loop_->startDevices(); !started) return started;
  try {
    startThreads(seconds);
  } catch (const std::system_error&) {
    loop_->stopDevices();
    stop_recorder_ = true;
    engine_->watchdog.end();
    if (recorder_thread_.joinable()) recorder_thread_.join();
    watchdog_thread_.end(0ms, [] { return false; });
    return outOfMemory(tr("for the threads of the exercise"), tr("the system"));
  }
  running_ = true;
  if (recorder_) noteRecording(recording_file_);
  return {};
}

void Session::startThreads(double seconds) {
  const auto last_tick = std::uint64_t(std::llround(seconds * exercise_.rate_hz));
  engine_->oper.useHostClock();
  recorder_thread_ = std::thread([this] { record(); });
  watchdog_thread_ = rt::AbandonableThread([engine = engine_] {
    rt::nameThread("watchdog");
    rt::requestRealTime(kWatchdogPriority);
    engine->watchdog.run();
  });
  haptic_thread_ = rt::AbandonableThread([engine = engine_, last_tick] {
    rt::nameThread("haptic");
    rt::sharpenTimers();
    rt::touchStack();
    engine->locked.emplace();  // some 70 ms, in which others are to have their turn
    if (!engine->locked->whole()) {
      spdlog::warn("{}", memoryNotLocked(engine->locked->reason()).sentence());
    }
    if (!rt::requestRealTime(kHapticPriority)) {
      spdlog::info("The haptic thread runs without real-time priority");
    }
    engine->memory_known.store(true, std::memory_order_release);
    HostClock clock;
    const bool here = engine->loop.run(clock, engine->stop, last_tick);
    engine->finished.store(true, std::memory_order_release);
    if (here) engine->loop.stopDevices();
  });
}

bool Session::finished() const {
  return engine_->finished.load(std::memory_order_acquire);
}

double Session::standsStillFor_s() const {
  return engine_->watchdog.stillFor_s();
}

std::optional<bool> Session::memoryLocked() const {
  if (!engine_->memory_known.load(std::memory_order_acquire)) return {};
  return engine_->locked->whole();
}

Status Session::startStepped(double seconds) {
  if (Status started = loop_->startDevices(); !started) return started;
  last_tick_ = std::uint64_t(std::llround(seconds * exercise_.rate_hz));
  engine_->finished = last_tick_ == 0;
  running_ = stepped_ = true;
  return {};
}

void Session::advance(double seconds) {
  if (!running_ || !stepped_ || !(seconds > 0.0)) return;
  const double ticks = std::min(std::round(seconds * exercise_.rate_hz), double(last_tick_));
  const std::uint64_t until = std::min(last_tick_, loop_->ticks() + std::uint64_t(ticks));
  while (loop_->ticks() < until) {
    loop_->step(0);
    const bool waits = core_->journalState() != (kJournalRoom | kJournalReady);
    const bool full = loop_->carves().size() > loop_->carves().capacity() / 2;
    if (waits || full || loop_->ticks() % drainTicks() == 0) drain();
  }
  drain();
  if (loop_->ticks() == last_tick_) engine_->finished.store(true, std::memory_order_release);
}

// So often that no ring can fill, which hold thousands of ticks, and that a kill costs no more of a
// slow session than of a fast one.
std::uint64_t Session::drainTicks() const {
  return std::clamp<std::uint64_t>(std::uint64_t(kFlushEvery_s * exercise_.rate_hz), 1, 256);
}

// Devices are stopped on this thread, so nobody can leave it behind.
Status Session::stopStepped() {
  loop_->stopDevices();
  drain();
  running_ = false;
  return finishRecording();
}

Status Session::stop() {
  if (!running_) return recordingStatus();
  if (stepped_) return stopStepped();
  engine_->stop = true;
  const bool silenced = engine_->watchdog.silence(kSilencePatience);
  // A thread that is in no device's call comes to its end: a tick is short.
  const std::optional<std::size_t> held =
      haptic_thread_.end(kStopPatience, [this] { return loop_->leaveBehind(); });
  engine_->watchdog.end();
  watchdog_thread_.end(0ms, [&] { return !silenced; });
  stop_recorder_ = true;
  recorder_thread_.join();
  if (held) leaveBehind(*held, silenced);
  engine_->locked->release();
  running_ = false;
  noteRecording({});
  return finishRecording();
}

// The device `held` keeps the haptic thread: says so in the recording, and closes the others.
void Session::leaveBehind(std::size_t held, bool watchdog_ended) {
  const LoopDevice& stuck = loop_->devices()[held];
  stuck.device->leaveBehind();
  std::string names;
  const std::uint64_t tick = loop_->ticks();
  const auto add = [&](const Event& event) {
    tellSinks([&](RecordSink& sink) { sink.event(event); });
  };
  if (loop_->silenceIsPending()) add({tick, EventKind::silenced, -1, 0, {}});
  for (std::size_t arm : stuck.arms) {
    add({tick, EventKind::fault, std::int32_t(arm), kFaultStuck, {}});
    const std::string name = "'" + exercise_.arms[arm].name + "'";
    names = names.empty() ? name : tr("{} and {}", names, name);
  }
  const bool pedal = stuck.arms.empty();
  const std::string plugin =
      pedal ? rig_.pedal->plugin : rig_.arms[stuck.arms.front()].device.plugin;
  left_behind_ = Error{
      code::kDeviceStuck,
      (pedal                   ? tr("The pedal stopped answering and was left behind")
       : stuck.arms.size() > 1 ? tr("The arms {} stopped answering and were left behind", names)
                               : tr("The arm {} stopped answering and was left behind", names)),
      tr("device '{}'", plugin),
      tr("What was done until then is recorded. Switch the arm off and on, then "
         "start Trephine again")};
  // A watchdog that a device holds as well still knows the others; they are silent, and close with
  // the engine.
  if (watchdog_ended) loop_->closeOthers(held);
}

Status Session::freewheel(double seconds, const Progress& progress) {
  if (Status started = startStepped(seconds); !started) return started;
  for (std::uint64_t ticks = 1; !finished() && !progress.cancelled(); ticks = drainTicks()) {
    advance(double(ticks) / exercise_.rate_hz);
    progress.at(double(loop_->ticks()) / double(last_tick_), tr("Running"));
  }
  const bool cancelled = !finished();
  Status ended = stop();
  if (cancelled) return Error{code::kCancelled, tr("The run was cancelled"), "", ""};
  return ended;
}

bool Session::freeze() {
  const LoopState& now = state();
  if (freeze_ == Freeze::none) {
    freeze_ = Freeze::settling;
    hands_.script_waits = true;
    engine_->live_hands.write(hands_);
    unsettled_tick_ = now.ticks;
  }
  // What was asked for before is taken up first, and shows in the state some ticks later.
  if (loop_->commands().size() > 0 || now.busy) unsettled_tick_ = now.ticks;
  if (now.ticks <= unsettled_tick_ + kAnswerTicks) return false;
  if (freeze_ == Freeze::settling) {
    paused_before_ = now.paused;
    if (!now.paused && !push(CommandKind::pause)) return false;
    freeze_ = Freeze::pausing;
    unsettled_tick_ = now.ticks;
    return false;
  }
  return now.paused;
}

void Session::thaw() {
  if (freeze_ == Freeze::none) return;
  const bool goes_on = freeze_ == Freeze::pausing && !paused_before_;
  freeze_ = Freeze::none;
  hands_.script_waits = false;
  engine_->live_hands.write(hands_);
  if (goes_on) (void)push(CommandKind::resume);
}

bool Session::send(CommandKind kind) {
  if (freeze_ == Freeze::none) return push(kind);
  // A pause that is asked for meanwhile stays.
  if (kind == CommandKind::pause && freeze_ == Freeze::pausing) paused_before_ = true;
  return kind == CommandKind::pause && freeze_ == Freeze::pausing;
}

bool Session::push(CommandKind kind) {
  const bool held = hands_.hands[0].held;
  if (kind == CommandKind::pause) holdHands(true);  // before the force goes
  const bool restores =
      kind == CommandKind::undo || kind == CommandKind::redo || kind == CommandKind::reset;
  if (restores) stopPushing();
  const bool sent = loop_->commands().push({kind, 0, {}});
  if (sent ? kind == CommandKind::resume : !held) holdHands(false);
  if (sent && kind == CommandKind::reset) {  // the tissue comes back around the tools
    for (std::size_t i = 0; i < begin_m_.size(); ++i) {
      if (!begin_m_[i]) continue;
      LiveHands::Hand& hand = hands_.hands[i];
      hand.position_m = hand.held_m = *begin_m_[i];
      // In a pause the pointer has not moved since: where it is, tissue may be again.
      if (hand.held) hand.pointed = false;
    }
    engine_->live_hands.write(hands_);
  }
  return sent;
}

bool Session::rewind(std::uint32_t second) {
  if (freeze_ != Freeze::none) return false;
  stopPushing();
  return loop_->commands().push({CommandKind::rewind, std::int32_t(second), {}});
}

bool Session::setController(ControllerKind kind) {
  return loop_->commands().push({CommandKind::controller, std::int32_t(kind), {}});
}

Status Session::setTissues(const TissueSet& tissues) {
  if (Status valid = validate(tissues, "tissues"); !valid) return valid;
  if (Status known = checkLabels(tissues, grid_->labels().get()); !known) return known;
  // Voxels are counted by a tissue's place in the set, so the places stay.
  const bool same_ids = std::equal(
      tissues.tissues.begin(), tissues.tissues.end(), exercise_.tissues.tissues.begin(),
      exercise_.tissues.tissues.end(), [](const Tissue& a, const Tissue& b) { return a.id == b.id; });
  if (!same_ids) {
    return Error{code::kOtherTissues, tr("A running exercise keeps its list of tissues"), "tissues",
                 tr("Stop it before tissues are added or removed")};
  }
  // Colours, opacities and names are the window's alone: the tick hears of what it uses.
  const TissueTable table = tissueTable(tissues);
  if (table != tissueTable(exercise_.tissues) &&
      !loop_->commands().push({CommandKind::tissues, 0, &engine_->tissues.emplace_back(table)})) {
    engine_->tissues.pop_back();
    return Error{code::kBusy, tr("Too many changes are waiting"), tr("the haptic loop"),
                 tr("Try again")};
  }
  exercise_.tissues = tissues;
  return {};
}

LoopState Session::state() {
  loop_->state().refresh();
  return loop_->state().value();
}

RunReport Session::report() const {
  RunReport report;
  report.done = meter_->metrics();
  report.done.ticks = loop_->ticks();  // also those whose records found no room
  setRemoved(report.done, exercise_, core_->journal(), cut_, grid_->geometry());
  report.structures_cut = structures_cut_;
  report.warnings = warnings_;
  std::ranges::copy(report.done.warnings, std::back_inserter(report.warnings));
  MachineHealth& machine = report.machine;
  machine.memory_locked = memoryLocked();
  if (machine.memory_locked == false) machine.memory_not_locked = engine_->locked->reason();
  machine.missed_deadlines = loop_->missed();
  machine.nonfinite = core_->nonFinite();
  machine.events_dropped = loop_->dropped();
  machine.recorder_behind_ms = 1e3 * double(most_behind_ticks_) / exercise_.rate_hz;
  machine.tick_ns = loop_->tickDurations().summary();
  report.volume_sha256_before = sha256_before_;
  report.volume_sha256 = sha256_after_;
  report.recording = recording_file_.string();
  return report;
}

}  // namespace trephine
